//! Every reader against damaged files: no input panics, and what is accepted keeps its promises.
//!
//! A second per reader in a normal run. Ten minutes each:
//!
//! ```sh
//! PBRDF_FUZZ_SECONDS=600 cargo test --release --no-default-features --test fuzz
//! ```
//!
//! Samples are made here and damaged by seeded chance; `PBRDF_FUZZ_SEED` draws others. An input that panics is kept in the folder for
//! temporary files, and its path is in the message.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

#[path = "common/damage.rs"]
mod damage;

use damage::{fuzz, texts};
use pbrdf::measurement::foreign::{LabTable, TableOptions};
use pbrdf::measurement::formats::{ImportOptions, Opened, open};
use pbrdf::measurement::{
    Ellipsometry, Mapping, Measurement, Tensor, TensorGrid, TensorResolution, grid_geometries, is_woollam, unwatched, write_tensor,
};
use pbrdf::model::{Model, Parameters, Pbrdf};
use pbrdf::optics::{SlopeDistribution, metals, read_metals};

/// What is written of an accepted measurement reads back the same.
fn assert_reads_back(read: &Measurement) {
    let mut written = Vec::new();
    read.write(&mut written).expect("memory takes everything");
    let again = Measurement::read(&written[..]).expect("what was written");
    assert_eq!(again.rows.len(), read.rows.len());
    for (again, row) in again.rows.iter().zip(&read.rows) {
        // Percent of a percent rounds; everything else is exact.
        assert_eq!((again.geometry, again.dolp, again.brdf, again.masked), (row.geometry, row.dolp, row.brdf, row.masked));
    }
}

const TABLES: [&str; 3] = [
    "# material: steel\ntheta_i,theta_r,dphi,dolp,dolp_sigma,brdf,brdf_sigma,masked\n30,20,180,0.1,0.01,2,0.1,0\n30,25,0,,,1e-3,,1\n",
    "theta_i;theta_r;dolp_percent;note\r\n30,5;-20;12,5;\"a; b\"\r\n40;20;0;x\r\n",
    "\u{feff}theta_i\ttheta_r\tbrdf\n30\t20\t1\n",
];

#[test]
fn measurement_tables() {
    fuzz("table", &texts(&TABLES), |bytes| Measurement::read(bytes).inspect(assert_reads_back).is_ok());
}

#[test]
fn mapped_tables() {
    let samples = ["AOI,View (rad),DoLP %,err\n30,0.3,12.5,0.1\n40,-0.2,1,1\n", "AOI;View;x;y\n30,5;0,1;3;4\n"];
    let mapping = Mapping::from_text("theta_i=1,theta_r=2:radians,dolp=3:percent,dolp_sigma=4:percent").expect("a mapping");
    fuzz("mapped", &texts(&samples), |bytes| {
        if let Ok(text) = std::str::from_utf8(bytes) {
            // Any text is a mapping or an error.
            let _ = Mapping::from_text(text);
        }
        mapping.read_table(bytes, &mut unwatched).is_ok()
    });
}

#[test]
fn woollam_texts() {
    let samples = [
        "A film\r\nVASEmethod[X=1]\r\nOriginal[a.dat]\r\nnm\r\n500\t60\t40\t150\t0.01\t0.02\r\n600\t60\t41\t150\t0.01\t0.02\r\ndpolE\t500\t60\t0.4\t1",
        "nm\taoi\tPsi\tDelta\n\n400\t65.00\t27.8\t109.7\n410\t65.00\t27.9\t109.5\n",
        "A\nVASEmethod[X]\nAngstroms\nE 5000 60 40 150 0.01 0.02\nuR 5000 60 inf 1\ndPolE 5000 60 1 0.1\n",
        "x\neV\n2.5 60 40 150\n",
    ];
    fuzz("woollam", &texts(&samples), |bytes| {
        let _ = is_woollam(bytes);
        let Ok(read) = Ellipsometry::read(bytes) else { return false };
        for wanted in [None, Some(500.0), read.wavelengths_nm().first().copied()] {
            if let Ok(found) = read.specular_dolp(wanted) {
                assert!(found.measurement.rows.iter().all(|row| row.dolp.is_some_and(|dolp| (0.0..=1.0).contains(&dolp.value))));
                assert_reads_back(&found.measurement);
            }
        }
        true
    });
}

#[test]
fn tensors() {
    let surface = Pbrdf::new(Model::full(SlopeDistribution::Gauss), Parameters::default()).expect("the defaults");
    let grid = TensorGrid::new(&surface, TensorResolution { phi_d: 3, theta_d: 3, theta_h: 2 });
    let mut sample = Vec::new();
    write_tensor(&surface, &grid, 550, &mut unwatched, &mut sample).expect("memory takes everything");
    let geometries = grid_geometries(&[0.0, 30.0, 89.0], &[-89.0, -30.0, 0.0, 30.0, 60.0], 180.0).expect("angles in range");
    fuzz("tensor", &[sample], |bytes| {
        let Ok(tensor) = Tensor::read(bytes) else { return false };
        for &wavelength in tensor.wavelengths_nm() {
            let slice = tensor.slice(&geometries, Some(wavelength)).expect("a band of the file");
            assert_eq!(slice.measurement.rows.len() + slice.without_value, geometries.len());
            if !slice.measurement.rows.is_empty() {
                assert_reads_back(&slice.measurement);
            }
        }
        true
    });
}

/// Files whose form is told by their content.
#[test]
fn opened_files() {
    let samples = [
        "nm\taoi\tPsi\tDelta\n400\t65\t27.8\t109.7\n410\t65\t27.9\t109.5\n",
        "AOI,View,DoLP %\n30,20,12.5\n40,-20,1\n",
        "#sample \"C\"\n#wavelength 650 nm\n#incident_angle 40 180\n#format: theta phi DSF\n20.00\t0.00\t2.9e-01\n20 180 nan\n120 0 1\n",
        "#intheta 150\n#inphi 0\n#theta phi BRDF\n160 0 1\n170 90 -1\n",
    ];
    fuzz("opened", &texts(&samples), |bytes| {
        let Ok(Opened::Foreign(file)) = open(bytes.to_vec(), &mut unwatched) else { return false };
        if let Ok(imported) = file.import(&ImportOptions::offered(&file.questions()), &mut unwatched) {
            imported.measurements.iter().for_each(assert_reads_back);
        }
        true
    });
}

/// Tables of other laboratories, as text.
#[test]
fn foreign_tables() {
    let samples = [
        "Probe;Stahl\n\nEinfall (Grad);Ausfall (Grad);DoLP in %;Fehler\n30;20;12,5;0,1\n30;-20;;0,1\n40;25;13,5;\nMittel;;7;\n",
        "sample,lambda (nm),theta_i,theta_r,S0,S1,S2\nA,450,30,20,1,0.1,0.01\nA,550,30,20,1,0.2,0.01\nB,450,40,20,2,0.1,0\n",
    ];
    fuzz("foreign", &texts(&samples), |bytes| read_foreign(bytes.to_vec(), &TableOptions::default()));
}

/// Reads as the window and `import --auto` do: the guess, and the table.
fn read_foreign(bytes: Vec<u8>, options: &TableOptions) -> bool {
    let Ok(table) = LabTable::open(bytes, options, &mut unwatched) else { return false };
    let _ = table.first_rows(20);
    if table.guess(options).is_err() {
        return false;
    }
    let Ok(imported) = table.read(options, &mut unwatched) else { return false };
    // A set whose values are all left out is written beside others only.
    let has_values = |measurement: &&Measurement| measurement.rows.iter().any(|row| row.dolp.is_some() || row.brdf.is_some());
    imported.measurements.iter().filter(has_values).for_each(assert_reads_back);
    true
}

/// Workbooks: bytes of an old one, and parts of a new one, which are packed again after the damage.
#[cfg(feature = "workbooks")]
#[test]
fn workbooks() {
    use std::io::{Cursor, Read as _, Write as _};
    let file = |name: &str| {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/workbooks").join(name);
        std::fs::read(path).expect("a file of the repository")
    };
    let options = TableOptions { sheet: Some("data".to_owned()), ..TableOptions::default() };
    fuzz("xls", &[file("steel.xls")], |bytes| read_foreign(bytes.to_vec(), &options));
    for (name, part) in [("steel.xlsx", "xl/worksheets/sheet2.xml"), ("steel.xlsx", "xl/workbook.xml"), ("steel.ods", "content.xml")] {
        let mut archive = zip::ZipArchive::new(Cursor::new(file(name))).expect("an archive");
        let mut parts: Vec<(String, Vec<u8>)> = Vec::new();
        for index in 0..archive.len() {
            let mut entry = archive.by_index(index).expect("an entry");
            let mut bytes = Vec::new();
            entry.read_to_end(&mut bytes).expect("memory takes everything");
            parts.push((entry.name().expect("a name").into_owned(), bytes));
        }
        let sample = parts.iter().find(|(name, _)| name == part).expect("the part").1.clone();
        fuzz(part.rsplit('/').next().unwrap_or(part), &[sample], |damaged| {
            let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
            let stored = zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
            for (name, bytes) in &parts {
                writer.start_file(name, stored).expect("memory takes everything");
                writer.write_all(if name == part { damaged } else { bytes }).expect("memory takes everything");
            }
            read_foreign(writer.finish().expect("memory takes everything").into_inner(), &options)
        });
    }
}

#[test]
fn tables_of_metals() {
    let sample = "# metal: X | ex\n# source: X/A | A 1999 | J. 1, 2 | film\nsource,wavelength_nm,n,k\nX/A,400,1,2\nX/A,500,2,6\n";
    assert!(metals().is_ok());
    fuzz("metals", &texts(&[sample]), |bytes| {
        let Ok(metals) = read_metals(&String::from_utf8_lossy(bytes)) else { return false };
        for source in metals.iter().flat_map(|metal| &metal.sources) {
            let (low, high) = source.range_nm();
            for share in [0.0, 0.3, 1.0] {
                let index = source.index_at((low + share * (high - low)).clamp(low, high)).expect("within the range");
                assert!(index.n() >= 0.0 && index.k_m() >= 0.0);
            }
        }
        true
    });
}
