//! Keys held by ssh-agent: `ssh-keygen -Y sign -f key.pub` signs, and we verify.

use crate::{Bench, NAMESPACE, PRINCIPAL};
use dtg_passport::trust::Signature;
use std::fs;
use std::os::unix::net::UnixStream;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// An agent of its own, ended with the test.
pub(crate) struct Agent {
    child: Child,
    pub(crate) socket: PathBuf,
}

impl Agent {
    pub(crate) fn start(bench: &Bench) -> Self {
        let socket = bench.path("agent");
        let child =
            Command::new("ssh-agent").arg("-D").arg("-a").arg(&socket).stdout(Stdio::null()).spawn().unwrap_or_else(
                |error| panic!("`ssh-agent` cannot be started ({error}); install it (Debian: openssh-client)"),
            );
        let agent = Self { child, socket };
        let deadline = Instant::now() + Duration::from_secs(20);
        // The file of the socket is there before the agent listens.
        while UnixStream::connect(&agent.socket).is_err() {
            assert!(Instant::now() < deadline, "ssh-agent does not listen at its socket");
            std::thread::sleep(Duration::from_millis(5));
        }
        agent
    }
}

impl Drop for Agent {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn the_agent_signs_and_we_verify() {
    let bench = Bench::new();
    let agent = Agent::start(&bench);
    let key = bench.new_key("key");
    let with_agent = |program: &str, arguments: &[&str], input: &[u8]| {
        bench.run(Command::new(program).env("SSH_AUTH_SOCK", &agent.socket).args(arguments), input)
    };
    let sign = ["-Y", "sign", "-q", "-f", "key.pub", "-n", NAMESPACE];
    let added = with_agent("ssh-add", &["-q", "key"], b"");
    assert!(added.good, "{}", added.errors);
    fs::remove_file(bench.path("key")).unwrap();
    bench.write("signers", format!("{PRINCIPAL} {}\n", key.public_key().to_openssh()));
    for message in [&b""[..], b"text\n", &[9; 50_000]] {
        let signed = with_agent("ssh-keygen", &sign, message);
        assert!(signed.good, "{}", signed.errors);
        assert_eq!(signed.output, key.sign(NAMESPACE, message).unwrap().to_armor());
        assert_eq!(Signature::from_armor(&signed.output).unwrap().verify(NAMESPACE, message), Ok(()));
        assert!(bench.verify("signers", &signed.output, message, &[]).good);
    }
    assert!(with_agent("ssh-add", &["-q", "-D"], b"").good);
    assert!(!with_agent("ssh-keygen", &sign, b"text\n").good, "the key is no longer in the agent");
    assert!(!bench.run(Command::new("ssh-keygen").args(sign), b"text\n").good, "no agent");
}
