//! Keys held by ssh-agent: `ssh-keygen -Y sign -f key.pub` signs, and we verify.

use crate::Bench;
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
