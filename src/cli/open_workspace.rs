//! The workspace of this process; there is at most one.

use crate::workspace::Workspace;
use std::path::PathBuf;
use std::sync::OnceLock;

static WORKSPACE: OnceLock<Workspace> = OnceLock::new();

/// The folder that the command line or the environment names, which need not be a workspace yet.
static FOLDER: OnceLock<PathBuf> = OnceLock::new();

pub(super) fn set(workspace: Workspace) {
    let _ = WORKSPACE.set(workspace);
}

pub(super) fn set_folder(folder: PathBuf) {
    let _ = FOLDER.set(folder);
}

pub(super) fn workspace() -> Option<&'static Workspace> {
    WORKSPACE.get()
}

pub(super) fn folder() -> Option<&'static PathBuf> {
    FOLDER.get()
}
