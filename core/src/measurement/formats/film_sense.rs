//! Film Sense text (FS-1, FS-8): `Film_Sense_Data`, the number of wavelengths, a line for each that
//! begins with it in nm, then a line of N, C, S for each: N = cos 2ψ, C = sin 2ψ cos Δ,
//! S = sin 2ψ sin Δ. The file does not state the angle of incidence.

use super::error::ImportError;
use super::format::{ForeignFile, Format};
use super::imported::Imported;
use super::question::{ImportOptions, Question};
use super::text_line::for_each_line;
use crate::measurement::{Ellipsometry, Expected, Progress, PsiDelta, ReadErrorKind};

/// Film Sense text as a form of files.
pub(super) struct FilmSense;

/// ψ and Δ of each wavelength, at an angle that is not known yet.
struct Spectrum(Ellipsometry);

impl Format for FilmSense {
    fn name(&self) -> &'static str {
        "Film Sense text"
    }

    fn help(&self) -> &'static str {
        "\
Film Sense text: N, C and S at one angle of incidence, which --theta-i gives; as Woollam text."
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["txt"]
    }

    fn sniff(&self, bytes: &[u8]) -> bool {
        bytes.trim_ascii_start().starts_with(b"Film_Sense_Data")
    }

    fn open(&self, bytes: Vec<u8>, progress: Progress<'_>) -> Result<Box<dyn ForeignFile>, ImportError> {
        let mut found = Ellipsometry::default();
        let mut count = None;
        let mut wavelengths: Vec<f64> = Vec::new();
        for_each_line(&bytes, progress, |line| {
            let is_head = line.text.starts_with("Film_Sense_Data");
            match count {
                _ if is_head => {}
                None => {
                    let stated = line.number(0, "number of wavelengths", Expected::FiniteNumber, |count| {
                        (1.0..=1000.0).contains(&count) && count.fract() == 0.0
                    })?;
                    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number from 1 to 1000")]
                    let stated = stated as usize;
                    count = Some(stated);
                }
                Some(count) if wavelengths.len() < count => {
                    wavelengths.push(line.number(0, "wavelength", Expected::Wavelength, |nm| nm > 0.0)?);
                }
                Some(count) if found.rows.len() < count => {
                    // Noise may exceed 1 a little.
                    let share = |cell: usize, name: &str| line.number(cell, name, Expected::FiniteNumber, |share| share.abs() <= 1.1);
                    let (n, c, s) = (share(0, "N")?, share(1, "C")?, share(2, "S")?);
                    let psi = 0.5 * libm::atan2(libm::hypot(c, s), n).to_degrees();
                    let delta = libm::atan2(s, c).to_degrees();
                    let wavelength_nm = wavelengths[found.rows.len()];
                    found.rows.push(PsiDelta { wavelength_nm, theta_i: 0.0, psi, delta, sigma_psi: None, line: line.number });
                }
                Some(_) => {}
            }
            Ok(())
        })?;
        if found.rows.is_empty() { Err(ReadErrorKind::NoPsi.anywhere().into()) } else { Ok(Box::new(Spectrum(found))) }
    }
}

impl ForeignFile for Spectrum {
    fn summary(&self) -> &'static str {
        "Film Sense ellipsometry: N, C and S become the specular DoLP at the angle of incidence that you give."
    }

    fn questions(&self) -> Vec<Question> {
        let mut questions = vec![Question::ThetaI];
        questions.extend(self.0.questions());
        questions
    }

    fn import(&self, options: &ImportOptions, progress: Progress<'_>) -> Result<Imported, ImportError> {
        let [theta_i] = options.theta_i[..] else { return Err(ImportError::NoThetaI) };
        let mut at_angle = self.0.clone();
        at_angle.rows.iter_mut().for_each(|row| row.theta_i = theta_i);
        crate::optics::Geometry::new(theta_i, theta_i, 180.0)?;
        at_angle.import(options, progress)
    }
}
