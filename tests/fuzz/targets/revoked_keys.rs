#![no_main]
dtg_passport_fuzz::target!("revoked_keys");
