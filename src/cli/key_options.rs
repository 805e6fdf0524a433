//! Values of the options `--key` and `--identity`: the signing key and the issuer. The passphrase of an encrypted key comes
//! from a terminal or from the environment.

use super::{Failure, open_workspace, output, trust_options};
use crate::document::Signer;
use crate::folder::{Authority, Memory};
use crate::passport::Trust;
pub(super) use crate::signing::PASSPHRASE_VARIABLE;
use crate::signing::{self, KeyFileError};
use crate::text::shown;
use crate::trust::{AllowedSigners, BadIdentity, PublicKey, check_identity};
use crate::workspace::Workspace;
use clap::Args;
use jiff::Timestamp;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use zeroize::Zeroizing;

/// Returns the path of the public half of a key.
pub(super) fn with_pub(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".pub");
    PathBuf::from(name)
}

pub(super) fn identity(text: &str) -> Result<String, BadIdentity> {
    check_identity(text).map(|()| text.to_owned())
}

/// Options of a verb that may sign.
#[derive(Args)]
pub(super) struct SigningOptions {
    /// Private key file, or a .pub file whose private half is in ssh-agent or a FIDO token
    #[arg(long, help_heading = "Signing", value_name = "KEY")]
    pub key: Option<PathBuf>,
    /// Issuer: the principal of the key in allowed_signers
    #[arg(long, help_heading = "Signing", value_name = "WHO", value_parser = identity)]
    pub identity: Option<String>,
    /// Key that signs the registers, of a second person [default: that of --key]
    #[arg(long, value_name = "KEY")]
    register_key: Option<PathBuf>,
    /// Compute and check everything, and list what would be done, but write nothing. No key is required; if one is
    /// given, it is checked as far as possible without its passphrase
    #[arg(short = 'n', long)]
    pub dry_run: bool,
}

/// Options of a verb that signs.
#[derive(Args)]
#[command(
    mut_arg("key", |key| key.required_unless_present("dry_run")),
    mut_arg("identity", |identity| identity.required(true))
)]
pub(super) struct IssuerOptions {
    #[command(flatten)]
    pub signing: SigningOptions,
    /// Leave the registers to a second person, who lists the passports with `register DIR --renew --adopt`; until then they
    /// do not count
    #[arg(long, conflicts_with = "register_key")]
    without_register: bool,
}

/// Keys of an issuer, and the time of the clock.
pub(super) struct Keys<'a> {
    options: &'a SigningOptions,
    without_register: bool,
    signer: Option<Box<dyn Signer + Sync>>,
    register_signer: Option<Box<dyn Signer + Sync>>,
    /// Public half of the key, if there is one and it is known before it signs.
    pub public: Option<PublicKey>,
    register_public: Option<PublicKey>,
    memory: Option<&'static Memory>,
}

impl IssuerOptions {
    /// Reads the keys, as [`SigningOptions::keys`] does.
    pub(super) fn keys(&self, passports: Option<&Path>) -> Result<Keys<'_>, Failure> {
        Ok(Keys { without_register: self.without_register, ..self.signing.keys(passports)? })
    }
}

impl SigningOptions {
    pub(super) fn identity(&self) -> &str {
        self.identity.as_deref().unwrap_or_default()
    }

    /// Returns `true` if no key is given.
    pub(super) fn lacks_key(&self) -> bool {
        self.key.is_none() && self.register_key.is_none()
    }

    /// Reads the keys. In a dry run they are checked as far as this needs no passphrase. A workspace remembers the registers
    /// of its own folder of passports.
    pub(super) fn keys(&self, passports: Option<&Path>) -> Result<Keys<'_>, Failure> {
        signing::forbid_core_dumps();
        let signs = |key: &Option<PathBuf>| {
            key.as_deref().filter(|_| !self.dry_run).map(|key| signing::signer(key, &ask)).transpose()
        };
        let (signer, register_signer) = (signs(&self.key)?, signs(&self.register_key)?);
        let public = public_key(self.key.as_deref(), signer.as_deref())?;
        let register_public = public_key(self.register_key.as_deref(), register_signer.as_deref())?;
        if register_public.is_some() && register_public == public {
            let words = "--register-key: is the key of --key; give the key of a second person, or omit it";
            return Err(Failure::usage(words));
        }
        let is_its_own = |workspace: &&Workspace| passports.is_some() && workspace.passports.as_deref() == passports;
        let memory = open_workspace::workspace().filter(is_its_own).map(Workspace::memory);
        Ok(Keys { options: self, without_register: false, signer, register_signer, public, register_public, memory })
    }
}

/// Returns the public half of a key, or `None` if there is no key, or if it is not known before the key signs. Without a
/// `signer`, in a dry run, no passphrase is asked for.
fn public_key(key: Option<&Path>, signer: Option<&(dyn Signer + Sync)>) -> Result<Option<PublicKey>, Failure> {
    match signer {
        Some(signer) => Ok(signer.public_key()),
        None => Ok(key.map(signing::key_to_sign_with).transpose()?),
    }
}

impl Keys<'_> {
    /// Returns the trust in the keys themselves, for a verb without `--trust`; a dry run without a key trusts nothing.
    ///
    /// # Errors
    /// Returns a failure if the public half of a key is not known before it signs.
    pub(super) fn own_trust(&self) -> Result<Trust, Failure> {
        match &self.public {
            Some(public) => {
                let own = signing::own_trust(self.options.identity(), public, self.register_public.as_ref());
                Ok(own.unwrap_or_else(|| Trust::of(AllowedSigners::default())))
            }
            None if self.signer.is_none() => Ok(Trust::of(AllowedSigners::default())),
            None => Err(Failure::unusable("the public half of the key is not known before it signs; specify --trust")),
        }
    }

    /// Returns the issuer with its keys.
    pub(super) fn authority<'a>(&'a self, trust: &'a Trust) -> Authority<'a> {
        let of_registers = self.register_signer.as_deref().or(self.signer.as_deref());
        Authority {
            issuer: self.options.identity(),
            trust,
            signer: self.signer.as_deref(),
            register_signer: of_registers.filter(|_| !self.without_register),
            clock: &trust_options::now,
            memory: self.memory,
        }
    }

    /// Refuses a dry run whose passports would fail verification by `trust`, as the passports themselves will be refused.
    pub(super) fn check_dry_run(&self, trust: &Trust, issued_at: Timestamp) -> Result<(), Failure> {
        let identity = self.options.identity();
        let key = self.public.as_ref().filter(|_| self.options.dry_run);
        let Some(why) = key.and_then(|key| signing::distrust(trust, key, identity, issued_at)) else { return Ok(()) };
        Err(Failure::refused(format!(
            "--identity {identity}: the new passports would fail verification by --trust ({why}); check --key, --identity \
             and --trust"
        )))
    }

    /// Says which passports do not count yet, because the registers are left to a second person.
    pub(super) fn say_without_register(&self) {
        if self.without_register && !self.options.dry_run {
            output::say(
                "the passports do not count until a second person lists them: `register DIR --renew --adopt SHA256`",
            );
        }
    }
}

impl From<KeyFileError> for Failure {
    fn from(error: KeyFileError) -> Self {
        match error {
            KeyFileError::File(error) => error.into(),
            error => Self::unusable(error),
        }
    }
}

/// Reads the passphrase of an existing key.
fn ask(key: &Path) -> Result<Zeroizing<String>, String> {
    passphrase(&format!("Passphrase of {}: ", shown(key)))
}

/// Reads a passphrase from the environment, or from the terminal.
pub(super) fn passphrase(prompt: &str) -> Result<Zeroizing<String>, String> {
    if let Ok(passphrase) = std::env::var(PASSPHRASE_VARIABLE) {
        return Ok(Zeroizing::new(passphrase));
    }
    if !std::io::stdin().is_terminal() {
        return Err(format!("no terminal is available for the passphrase of the key; set {PASSPHRASE_VARIABLE}"));
    }
    rpassword::prompt_password(prompt).map(Zeroizing::new).map_err(|error| match error.kind() {
        std::io::ErrorKind::UnexpectedEof => "no passphrase was entered; enter one".to_owned(),
        _ => error.to_string(),
    })
}
