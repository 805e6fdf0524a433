//! The workspace of this process.

use crate::workspace::Workspace;
use std::sync::OnceLock;

/// One command line names at most one workspace.
static WORKSPACE: OnceLock<Workspace> = OnceLock::new();

/// Sets the workspace, once, before anything reads it.
pub(super) fn set(workspace: Workspace) {
    let _ = WORKSPACE.set(workspace);
}

pub(super) fn workspace() -> Option<&'static Workspace> {
    WORKSPACE.get()
}

/// Returns `true` if the workspace cannot sign, so that it need not have every passport of a stand.
pub(super) fn is_of_a_laboratory() -> bool {
    workspace().is_some_and(|workspace| workspace.key.is_none())
}
