//! Time and size of the printed passport, including its verification; the page is written in memory:
//! `cargo bench --bench render`.

use dtg_passport::passport::{Question, Trust};
use dtg_passport::report::{Language, Languages, PassportPage};
use dtg_passport::trust::AllowedSigners;
use std::hint::black_box;
use std::time::Instant;

/// Pages in a round.
const PAGES: usize = 51;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let passport = include_bytes!("../passports/SPS-2/0017/moscow-bmstu-1.yaml");
    let trust = Trust::of(AllowedSigners::parse("allowed_signers", include_bytes!("../docs/allowed_signers"))?);
    let question = Question::at("2026-11-20T12:00:00Z".parse()?);
    let both = Languages::new(Language::English, [Language::Russian]);
    for (name, languages) in [("en", Language::English.into()), ("ru", Language::Russian.into()), ("en,ru", both)] {
        let mut milliseconds = Vec::with_capacity(PAGES);
        let mut bytes = 0;
        for _ in 0..PAGES {
            let start = Instant::now();
            let page = PassportPage::verified("passport", black_box(passport), &trust, &question);
            bytes = black_box(page.map_err(|_| "the passport does not verify")?.html(&languages)).len();
            milliseconds.push(start.elapsed().as_secs_f64() * 1e3);
        }
        milliseconds.sort_by(f64::total_cmp);
        println!("{name:<5}  {bytes} bytes, verified and rendered in {:.2} ms (median)", milliseconds[PAGES / 2]);
    }
    Ok(())
}
