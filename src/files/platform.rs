//! File operations that differ between Unix and Windows.

use std::fs::File;
use std::io;
use std::path::Path;

#[cfg(unix)]
mod system {
    use super::*;
    use rustix::fs::OFlags;
    use std::os::unix::fs::{OpenOptionsExt, PermissionsExt};

    pub(crate) fn open(path: &Path) -> io::Result<File> {
        let flags = OFlags::NONBLOCK | OFlags::NOCTTY;
        File::options().read(true).custom_flags(flags.bits().cast_signed()).open(path)
    }

    pub(crate) fn is_closed_pipe(error: &io::Error) -> bool {
        error.kind() == io::ErrorKind::BrokenPipe
    }

    pub(crate) fn wait_for_turn(folder: &Path) -> Option<File> {
        File::open(folder).ok().filter(|folder| folder.lock().is_ok())
    }

    pub(crate) fn sync_folder(folder: &Path) -> io::Result<()> {
        File::open(folder)?.sync_all()
    }

    pub(crate) fn readable_by_all(builder: &mut tempfile::Builder<'_, '_>) {
        // The umask restricts this mode; without it only the user could read the file.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
}

#[cfg(windows)]
mod system {
    use super::*;
    use crate::files::leftovers;
    use std::os::windows::fs::OpenOptionsExt;
    use std::time::Duration;

    /// Windows' `FILE_FLAG_DELETE_ON_CLOSE`: the file is removed with its last handle, also if the program is killed.
    const DELETE_ON_CLOSE: u32 = 0x0400_0000;
    /// Windows' `ERROR_ACCESS_DENIED`, while the file is being removed, and `ERROR_SHARING_VIOLATION`.
    const IN_USE: [i32; 2] = [5, 32];
    /// Windows' `ERROR_PIPE_NOT_CONNECTED`, which the standard library gives no kind.
    const PIPE_NOT_CONNECTED: i32 = 233;
    /// Number and length of the waits for another run, one minute in all.
    const WAITS: u32 = 1200;
    const WAIT: Duration = Duration::from_millis(50);

    pub(crate) fn open(path: &Path) -> io::Result<File> {
        File::open(path).map_err(|error| match path.ancestors().skip(1).any(Path::is_file) {
            true => io::ErrorKind::NotADirectory.into(),
            false => error,
        })
    }

    pub(crate) fn is_closed_pipe(error: &io::Error) -> bool {
        error.kind() == io::ErrorKind::BrokenPipe || error.raw_os_error() == Some(PIPE_NOT_CONNECTED)
    }

    // Windows cannot lock a folder. A file opened for exclusive use serves as the lock.
    pub(crate) fn wait_for_turn(folder: &Path) -> Option<File> {
        let path = folder.join(format!("{}lock{}", leftovers::PREFIX, leftovers::SUFFIX));
        for _ in 0..WAITS {
            let mut options = File::options();
            options.write(true).create(true).truncate(false).share_mode(0).custom_flags(DELETE_ON_CLOSE);
            match options.open(&path) {
                Ok(file) => return Some(file),
                Err(error) if error.raw_os_error().is_some_and(|code| IN_USE.contains(&code)) => {
                    std::thread::sleep(WAIT);
                }
                Err(_) => return None,
            }
        }
        None
    }

    pub(crate) fn sync_folder(_: &Path) -> io::Result<()> {
        Ok(())
    }

    pub(crate) fn readable_by_all(_: &mut tempfile::Builder<'_, '_>) {}
}

/// Returns `true` if the reader at the other end of a pipe has closed it.
pub(crate) use system::is_closed_pipe;
/// Opens a file without waiting, because a pipe without a writer would block its reader indefinitely. The kind of file
/// is then read from the open file, so that it cannot be exchanged in between.
pub(crate) use system::open;
/// Gives a new file the permissions that the umask, or on Windows the folder, allows.
pub(crate) use system::readable_by_all;
/// Syncs the names in a folder to disk, so that a power failure does not lose them. On Windows they need no sync.
pub(crate) use system::sync_folder;
/// Waits until no other run holds the lock of a folder, and locks it until the returned file is dropped. Returns `None`
/// if the folder cannot be locked.
pub(crate) use system::wait_for_turn;
