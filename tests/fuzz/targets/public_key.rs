#![no_main]
dtg_passport_fuzz::target!("public_key");
