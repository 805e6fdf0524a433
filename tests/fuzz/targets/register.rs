#![no_main]
dtg_passport_fuzz::target!("register");
