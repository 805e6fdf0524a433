//! WebAssembly of dtg-passport for browsers and Node.js. It only converts types and calls `dtg_passport::interface`.
//!
//! The module imports nothing. `dtg_passport.mjs` creates a new instance for every call, so memory is never given back,
//! and nothing of one passport can reach the next.

use dtg_passport::interface::{Answer, Enquiry, Failed, calibrate_json, content_json};
use dtg_passport::jiff::Timestamp;
use dtg_passport::report::{Language, Languages, PassportPage};

/// Bytes in the memory of the module.
#[repr(C)]
pub struct Slice {
    start: *const u8,
    length: usize,
}

/// Inputs of every call; those that a call does not use are empty.
#[repr(C)]
pub struct Inputs {
    passport: Slice,
    signers: Slice,
    question: Slice,
    currents: Slice,
    order: Slice,
}

/// Returns room for `length` bytes, at an address that fits [`Inputs`].
#[unsafe(no_mangle)]
pub extern "C" fn room(length: usize) -> *mut u8 {
    Box::leak(vec![0_u64; length.div_ceil(8)].into_boxed_slice()).as_mut_ptr().cast()
}

/// Verifies a passport; `now_s` is the time in seconds since 1970 UTC. Gives `{file, valid, id, not_asked,
/// remarks, checks}` or `{error}`.
#[unsafe(no_mangle)]
pub extern "C" fn verify(inputs: &Inputs, now_s: f64) -> *const Slice {
    run(inputs, now_s, |_, answer| Ok(answer.to_json()))
}

/// Verifies a passport and gives its `sha256` and its content as JSON, or the answer of [`verify`] if a check failed.
#[unsafe(no_mangle)]
pub extern "C" fn content(inputs: &Inputs, now_s: f64) -> *const Slice {
    run(inputs, now_s, |_, answer| {
        let passport = answer.verification.passport();
        let with_sha256 = |json: &str| format!(r#"{{"sha256":"{}",{}"#, answer.sha256, &json[1..]);
        Ok(passport.map_or_else(|| answer.to_json(), |passport| with_sha256(&content_json(passport.content()))))
    })
}

/// Verifies a passport and gives it in printed form, one HTML document in English; or the answer of [`verify`] if it is
/// not authentic.
#[unsafe(no_mangle)]
pub extern "C" fn print(inputs: &Inputs, now_s: f64) -> *const Slice {
    run(inputs, now_s, |Enquiry { question, .. }, answer| {
        let page = PassportPage::of(inputs.passport.bytes(), question, answer.verification.clone());
        Ok(page.map_or_else(|_| answer.to_json(), |page| page.html(&Languages::from(Language::English))))
    })
}

/// Verifies a passport and calibrates a gyro from currents as CSV, with an order as JSON; or gives the answer of
/// [`verify`] if a check failed.
#[unsafe(no_mangle)]
pub extern "C" fn calibrated(inputs: &Inputs, now_s: f64) -> *const Slice {
    run(inputs, now_s, |_, answer| {
        let order = inputs.order.text()?.parse()?;
        let Some(passport) = answer.verification.passport() else { return Ok(answer.to_json()) };
        let verified = Some((answer.time, answer.verification.register()));
        calibrate_json(passport.content(), verified, ("currents", inputs.currents.bytes()), &order)
    })
}

fn run(inputs: &Inputs, now_s: f64, give: impl FnOnce(&Enquiry, &Answer) -> Result<String, Failed>) -> *const Slice {
    let found = || {
        let now = Timestamp::from_second(now_s as i64).map_err(Failed::unusable)?;
        let enquiry = Enquiry::new(("allowed_signers", inputs.signers.bytes()), &[], inputs.question.text()?, now)?;
        give(&enquiry, &enquiry.verify("passport", inputs.passport.bytes()))
    };
    let text: &'static str = Box::leak(found().unwrap_or_else(|failed| failed.to_json()).into_boxed_str());
    Box::leak(Box::new(Slice { start: text.as_ptr(), length: text.len() }))
}

impl Slice {
    fn text(&self) -> Result<&str, Failed> {
        std::str::from_utf8(self.bytes()).map_err(Failed::unusable)
    }

    fn bytes(&self) -> &[u8] {
        if self.length == 0 {
            return &[];
        }
        // SAFETY: `dtg_passport.mjs` writes addresses and lengths that it got from `room`.
        unsafe { std::slice::from_raw_parts(self.start, self.length) }
    }
}
