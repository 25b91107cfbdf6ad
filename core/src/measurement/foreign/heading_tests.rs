use super::{At, ColumnHeading, Meaning};
use crate::measurement::foreign::vocabulary::Measure;
use crate::measurement::{BrdfMeaning, Channel, Field};

#[test]
fn headings_of_three_languages_mean_their_fields() {
    use Field as F;
    let mut wrong = Vec::new();
    for (field, headings) in [
        (
            F::ThetaI,
            "theta_i|AOI|AOI (deg)|inc|Incidence|incident angle|Angle of Incidence [°]|θi|θ_i / °|ϑ_i|theta_in|ThetaIn|thetaInc|Einfallswinkel|Einfallswinkel [°]|入射角|入射角(度)|入射角 θi|入射天顶角|SZA|illumination angle|source angle|Theta incidence|incAngle|inc_rad|angle_of_incidence_deg|Beleuchtungswinkel|Einstrahlwinkel|ti|Incident_angle|incidence zenith",
        ),
        (
            F::ThetaR,
            "theta_r|view|View angle|VA [°]|VZA|θr|θ_r|theta_det|theta_v|theta_s|theta_out|Beobachtungswinkel [°]|Betrachtungswinkel|Ausfallswinkel|Detektorwinkel|Streuwinkel|观测角|观察角|探测角|反射角|出射角|detector angle|Detector angle (deg)|scattering angle|reflection angle|angle of reflection|emission angle|exit angle|observation|viewing zenith angle|viewing_angle_rad|Measure_angle|camera angle|Messwinkel|receiver angle|tr|Reflexionswinkel|观测天顶角|接收角|散射角",
        ),
        (F::Dphi, "dphi|Δφ|delta phi|Δϕ/°|relative azimuth|RAA|azimuth|phi|rel. azimuth|相对方位角|方位角|Azimut|Relativazimut"),
        (F::PhiI, "phi_i|φi|incident azimuth"),
        (F::PhiR, "phi_r|φ_r|view azimuth|phi_s|观测方位角"),
        (
            F::Dolp,
            "dolp|DoLP|DOLP|DoLP (%)|DoLP %|dolp_percent|DOP|P|pol|polarization|degree of linear polarisation|degree of polarization|DLP|Polarisationsgrad|linearer Polarisationsgrad [%]|偏振度|线偏振度|偏振度(%)|pol_percent|Degree of Linear Polarization|DOP [%]",
        ),
        (
            F::DolpSigma,
            "dolp_sigma|DoLP_err|DoLP err|dolp error|std_dolp|DoLP std|σ_DoLP|sigma DoLP|u(DoLP)|ΔDoLP|DoLP uncertainty|DOP err [%]|偏振度误差|Fehler DoLP|DoLP ±|dolperr|Standardabweichung DoLP|polarization error|Unsicherheit Polarisationsgrad",
        ),
        (
            F::Brdf,
            "brdf|BRDF|BRDF [1/sr]|BRDF (sr^-1)|BRDF 1/sr|BRDF / sr⁻¹|fr|f_r|BSDF|双向反射分布函数|Reflectance|reflectance factor|Reflexionsfaktor|BRDF cos|反射率|radiance factor",
        ),
        (F::BrdfSigma, "brdf_sigma|BRDF err|BRDF error [1/sr]|u(BRDF)|Reflectance error|sigma_BRDF"),
        (F::Wavelength, "wavelength|wavelength_nm|Wavelength (nm)|λ|λ/nm|lambda [nm]|Wellenlänge|Wellenlaenge (nm)|波长|波长(nm)|nm|WL"),
        (F::Set, "sample|Sample|Sample name|Probe|Probenname|样品|material|specimen|set|Muster"),
        (F::Masked, "masked|mask|excluded"),
        (F::Channel(Channel::S0), "S0|s0|Stokes S0|S_0|S₀|S0 [counts]"),
        (F::Channel(Channel::S1), "S1|S_1|S1 (counts)|S1/S0|s1 norm"),
        (F::ChannelSigma(Channel::S1), "S1_err|sigma_S1|S1 error|u(S1)|σ(S1)|S1err|dS1|S1 std|Fehler S1"),
        (F::Channel(Channel::I0), "I0|I_0|I(0°)|I 0°|Intensity 0 deg|I0 [counts]"),
        (F::Channel(Channel::I45), "I45|I_45|I(45)|Intensität 45°|I 45|光强45"),
        (F::Channel(Channel::I135), "I135|I_135"),
        (F::ChannelSigma(Channel::I90), "I90_err|sigma I90"),
        (F::Channel(Channel::Rs), "Rs|R_s|Is|R_perp|R⊥|R s-pol"),
        (F::Channel(Channel::Rp), "Rp|R_p|Ip|R∥|R_par|R (p)"),
        (F::Channel(Channel::Psi), "psi|Psi|ψ|Psi (deg)|ψ/°"),
        (F::ChannelSigma(Channel::Psi), "sigma_psi|psi error|Psi err"),
    ] {
        let taken = headings.split('|').map(|heading| (heading, ColumnHeading::new(heading).meaning));
        wrong.extend(taken.filter(|(_, meaning)| *meaning != Meaning::Field(field)).map(|(heading, meaning)| (field, heading, meaning)));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    for (meaning, headings) in [
        (Meaning::Angle, "Angle|theta|θ|Winkel|角度|Angle (deg)"),
        (Meaning::Sigma, "error|err|std|σ|sigma|±|Standardabweichung|误差|标准差|Fehler|uncertainty|unc|sd|stdev"),
        (Meaning::Value, "value|Wert|Messwert"),
        (
            Meaning::Unknown,
            "Delta|Δ|AoLP|angle of polarization|Polarisationswinkel|remark|time|temperature|Kommentar|#|No.|detector signal|偏振角|polarizer angle|S3|power|depolarization",
        ),
        (Meaning::Mueller { row: 0, column: 0, is_sigma: false }, "m00|M00|M_00|M(0,0)|mm00"),
        (Meaning::Mueller { row: 2, column: 1, is_sigma: false }, "m21|M21|Mueller 21|M[2][1]"),
        (Meaning::Mueller { row: 1, column: 0, is_sigma: true }, "m10_err|sigma_m10"),
    ] {
        for heading in headings.split('|') {
            assert_eq!(ColumnHeading::new(heading).meaning, meaning, "{heading}");
        }
    }
}

#[test]
fn headings_say_their_unit_and_what_brdf_is() {
    for (heading, measure) in [
        ("DoLP (%)", Some(Measure::Percent)),
        ("DoLP_percent", Some(Measure::Percent)),
        ("DoLP in %", Some(Measure::Percent)),
        ("DoLP%", Some(Measure::Percent)),
        ("偏振度（%）", Some(Measure::Percent)),
        ("theta_i (rad)", Some(Measure::Radians)),
        ("θ_i/rad", Some(Measure::Radians)),
        ("入射角(弧度)", Some(Measure::Radians)),
        ("Einfallswinkel in Grad", Some(Measure::Degrees)),
        ("BRDF [sr^-1]", Some(Measure::PerSteradian)),
        ("λ [µm]", Some(Measure::Micrometers)),
        ("AOI", None),
    ] {
        assert_eq!(ColumnHeading::new(heading).measure, measure, "{heading}");
    }
    for (heading, is) in [
        ("BRDF", Some(BrdfMeaning::Brdf)),
        ("BRDF·cos θr", Some(BrdfMeaning::BrdfCos)),
        ("BRDF cos", Some(BrdfMeaning::BrdfCos)),
        ("reflectance factor", Some(BrdfMeaning::Factor)),
        ("Reflexionsfaktor", Some(BrdfMeaning::Factor)),
        ("反射因子", Some(BrdfMeaning::Factor)),
        ("reflectance", None),
        ("Reflexionsgrad", None),
        ("反射率", None),
    ] {
        assert_eq!(
            (ColumnHeading::new(heading).meaning, ColumnHeading::new(heading).brdf_is),
            (Meaning::Field(Field::Brdf), is),
            "{heading}"
        );
    }
    assert!(ColumnHeading::new("S0 [1/sr]").is_brdf && ColumnHeading::new("S0 (BRDF)").is_brdf && !ColumnHeading::new("S0").is_brdf);
    assert!(ColumnHeading::new("S1/S0").is_normalised && !ColumnHeading::new("S1").is_normalised);
}

#[test]
fn headings_say_where_their_values_were_measured() {
    let at = At::default();
    for (heading, expected, meaning) in [
        ("30", At { bare: Some(30.0), ..at }, Meaning::Unknown),
        ("30°", At { bare: Some(30.0), ..at }, Meaning::Unknown),
        ("AOI 30", At { theta_i: Some(30.0), ..at }, Meaning::Unknown),
        ("AOI=30°", At { theta_i: Some(30.0), ..at }, Meaning::Unknown),
        ("AOI30", At { theta_i: Some(30.0), ..at }, Meaning::Unknown),
        ("θi = 30,5°", At { theta_i: Some(30.5), ..at }, Meaning::Unknown),
        ("入射角30°", At { theta_i: Some(30.0), ..at }, Meaning::Unknown),
        ("view -20", At { theta_r: Some(-20.0), ..at }, Meaning::Unknown),
        ("550 nm", At { wavelength_nm: Some(550.0), ..at }, Meaning::Unknown),
        ("0.55 µm", At { wavelength_nm: Some(550.0), ..at }, Meaning::Unknown),
        ("DoLP 450 nm", At { wavelength_nm: Some(450.0), ..at }, Meaning::Field(Field::Dolp)),
        ("DoLP_550nm", At { wavelength_nm: Some(550.0), ..at }, Meaning::Field(Field::Dolp)),
        ("450nm DoLP", At { wavelength_nm: Some(450.0), ..at }, Meaning::Field(Field::Dolp)),
        ("DoLP(450)", At { bare: Some(450.0), ..at }, Meaning::Field(Field::Dolp)),
        ("DoLP 30° [%]", At { bare: Some(30.0), ..at }, Meaning::Field(Field::Dolp)),
        ("BRDF 550 nm err", At { wavelength_nm: Some(550.0), ..at }, Meaning::Field(Field::BrdfSigma)),
        ("λ = 550", At { wavelength_nm: Some(550.0), ..at }, Meaning::Unknown),
    ] {
        let found = ColumnHeading::new(heading);
        assert_eq!((found.at, found.meaning), (expected, meaning), "{heading}");
    }
    for (corner, row, across) in [
        ("view angle\\AOI", Field::ThetaR, Field::ThetaI),
        ("AOI / view", Field::ThetaI, Field::ThetaR),
        ("θr\\θi", Field::ThetaR, Field::ThetaI),
        ("观测角\\入射角", Field::ThetaR, Field::ThetaI),
        ("view\\wavelength", Field::ThetaR, Field::Wavelength),
    ] {
        let found = ColumnHeading::new(corner);
        assert_eq!((found.meaning, found.across), (Meaning::Field(row), Some(across)), "{corner}");
    }
}
