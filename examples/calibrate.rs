//! Calibrates a gyro from your own readings, with a passport that is verified first:
//!
//! ```sh
//! cargo run --example calibrate -- passports/SPS-2/0017/moscow-bmstu-1.yaml docs/allowed_signers docs/currents.csv
//! ```

use dtg_passport::calibration::{Options, Parameter, Readings, Setup, calibrate};
use dtg_passport::jiff::Timestamp;
use dtg_passport::laboratory::Laboratory;
use dtg_passport::passport::{Question, Trust, verify};
use dtg_passport::trust::AllowedSigners;
use std::error::Error;
use std::fs;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, passport, signers, currents] = &arguments[..] else {
        return Err("usage: calibrate PASSPORT ALLOWED_SIGNERS CURRENTS".into());
    };

    // A real program also asks for the serial number and the place of the stand: `Question::serial`, `Question::place`.
    let trust = Trust::of(AllowedSigners::parse(signers, &fs::read(signers)?)?);
    let answer = verify(passport, &fs::read(passport)?, &trust, &Question::at(Timestamp::now()));
    let Some(verified) = answer.passport() else {
        let failed = answer.checks().iter().filter(|check| check.passed() == Some(false));
        return Err(failed.map(|check| check.detail.as_str()).collect::<Vec<_>>().join("\n").into());
    };

    // The paper's current meter; a laboratory reads its own `laboratory.yaml` with `Laboratory::from_yaml`.
    let laboratory = Laboratory::paper();
    let content = verified.content();
    let (setup, not_stated) = Setup::stated(&content.certificate, &content.positions, &content.site, &laboratory)?;
    let range_ma = laboratory.meter.range_ma;
    let readings = Readings::from_csv(currents, &fs::read(currents)?, setup.coefficients(), range_ma)?;

    let calibration = calibrate(&setup, &readings, &Options::default())?;
    // It is an error if the readings do not fit the stand. Only `interface::calibrate` compares with a gyro type.
    let result = calibration.valid()?;
    for parameter in Parameter::EIGHT {
        if let (Some(value), Some(u)) = (result.value(parameter), result.standard_uncertainty(parameter)) {
            println!("{:>5} = {value:9.4} {} (u = {u:.4})", parameter.symbol(), parameter.unit());
        }
    }
    for unknown in not_stated {
        println!("not included in u: {}", unknown.words());
    }
    Ok(())
}
