//! What is wrong with a scene, by place.

use core::fmt;

/// Why a scene is refused, or a scripted command of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneError {
    /// Where: `bodies[1].mass`; empty for the scene as a whole.
    pub path: String,
    /// What is wrong; for what JSON itself or a single value is wrong in, with line and column.
    pub message: String,
}

impl SceneError {
    pub(super) fn new(path: impl Into<String>, message: impl fmt::Display) -> Self {
        SceneError { path: path.into(), message: message.to_string() }
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.path.is_empty() { f.write_str(&self.message) } else { write!(f, "{}: {}", self.path, self.message) }
    }
}

impl core::error::Error for SceneError {}
