#![no_main]
dtg_passport_fuzz::target!("allowed_signers");
