//! Links: a scene or a lesson as the end of an address, which opens it wherever the program runs.
//!
//! `?scene=paper#PAYLOAD` is a built-in scene with changes, `?scene=#PAYLOAD` any other scene, and
//! `?lesson=NAME` a lesson. Whatever stands before the question mark is the address of a page. The payload is
//! JSON, compressed (deflate) and written in base64url.

use std::collections::BTreeMap;
use std::io::{Read, Write};

use base64::Engine;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use flate2::Compression;
use flate2::read::DeflateDecoder;
use flate2::write::DeflateEncoder;
use serde::{Deserialize, Serialize};

use super::arguments::arguments;
use super::document::{Document, Source};
use super::error::{SceneError, clip};
use super::files::Files;

/// Largest link in bytes; browsers take about as much.
const MAX_LINK: usize = 64 << 10;

/// Largest payload in bytes once it is decompressed.
const MAX_PAYLOAD: usize = 256 << 10;

/// Largest file in a link in bytes.
const MAX_FILE: usize = 8 << 10;

/// Name in messages of a scene from a link.
const NAME: &str = "the link";

/// Why a scene has no link.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum LinkError {
    /// A file that the scene names is too large.
    #[error(
        "{path} has {bytes} bytes, and a link holds files of at most {MAX_FILE}: send the scene file with it \
         instead"
    )]
    File {
        /// The path in the scene.
        path: String,
        /// Its size.
        bytes: usize,
    },
    /// A file that the scene names cannot be read.
    #[error("{0}")]
    Unreadable(String),
    /// The scene is too large.
    #[error("the scene is too large for a link: send its file instead")]
    Scene,
}

/// The payload behind the `#` of a link.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Payload {
    /// Changes of a built-in scene, `FIELD=VALUE`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    set: Vec<String>,
    /// The text of any other scene.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    text: String,
    /// Files that the scene names, by their paths in it.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    files: BTreeMap<String, String>,
}

/// Whether a text is a link, and not the name of a scene or of a file.
#[doc(hidden)]
pub fn is_link(text: &str) -> bool {
    query(text).is_some()
}

/// The lesson that a link opens, if it opens one.
#[doc(hidden)]
pub fn linked_lesson(text: &str) -> Option<&str> {
    match query(text)? {
        ("lesson", name, _) => Some(name),
        _ => None,
    }
}

/// The kind of document that a link opens, its name, and the payload.
fn query(text: &str) -> Option<(&str, &str, &str)> {
    let (_, query) = text.trim().split_once('?')?;
    let (query, payload) = query.split_once('#').unwrap_or((query, ""));
    // others may append parameters
    let mut parameters = query.split('&').filter_map(|parameter| parameter.split_once('='));
    let (kind, name) = parameters.find(|(kind, _)| ["scene", "lesson"].contains(kind))?;
    Some((kind, name, payload))
}

impl Document {
    /// The link to the scene with its changes. It begins with `?scene=`; put the address of a page before it.
    ///
    /// # Errors
    ///
    /// For a file of the scene that cannot be read, and a scene or file that is too large for a link.
    pub fn link(&self) -> Result<String, LinkError> {
        let mut payload = Payload::default();
        let mut name = "";
        let built_in = match self.source {
            Source::BuiltIn(preset) => Document::preset(preset).ok().map(|document| (preset, document.scene)),
            Source::File(_) | Source::Text => None,
        };
        if let Some((preset, scene)) = &built_in {
            let changes = arguments(scene, &self.scene);
            payload.set = changes.into_iter().map(|change| self.written(change)).collect();
            name = preset;
        } else {
            payload.text = self.write(&self.scene).map_err(|_| LinkError::Scene)?;
        }
        for path in self.paths() {
            let read = self.files.read(&path).map_err(|error| LinkError::Unreadable(error.to_string()))?;
            let embedded = Files { sealed: true, ..Files::default() }.read(&path);
            if embedded.is_ok_and(|embedded| embedded == read) {
                continue;
            }
            if read.len() > MAX_FILE {
                return Err(LinkError::File { path: clip(&path), bytes: read.len() });
            }
            payload.files.insert(path, read);
        }
        let mut link = format!("?scene={name}");
        if !(payload.set.is_empty() && payload.text.is_empty() && payload.files.is_empty()) {
            link += "#";
            link += &packed(&payload).ok_or(LinkError::Scene)?;
        }
        if link.len() <= MAX_LINK { Ok(link) } else { Err(LinkError::Scene) }
    }

    /// The scene that a link opens. Like that of a scene file, it is not checked yet.
    pub(super) fn from_link(link: &str) -> Result<Self, SceneError> {
        let wrong =
            |problem: &str| SceneError::Unreadable { name: NAME.to_owned(), problem: problem.to_owned() };
        if link.len() > MAX_LINK {
            return Err(wrong("it is longer than a link to a scene can be: ask for it again"));
        }
        let Some(("scene", name, payload)) = query(link) else {
            return Err(wrong("it opens no scene: a link to one has `?scene=`"));
        };
        let broken = "what stands behind its `#` is broken: copy the whole link, or ask for it again";
        let payload = match payload {
            "" => Payload::default(),
            packed => unpacked(packed).ok_or_else(|| wrong(broken))?,
        };
        let files = Files { folder: None, cached: payload.files, sealed: true };
        let mut document = match name {
            "" if payload.text.is_empty() => {
                return Err(wrong("it names no scene: a link has `?scene=NAME`, such as `?scene=paper`"));
            }
            "" => Self::from_text(NAME, &payload.text, files)?,
            name => {
                let mut document = Self::preset(name)?;
                document.files = files;
                document
            }
        };
        for change in &payload.set {
            document.set(change)?;
        }
        Ok(document)
    }
}

fn packed(payload: &Payload) -> Option<String> {
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(&serde_json::to_vec(payload).ok()?).ok()?;
    Some(URL_SAFE_NO_PAD.encode(encoder.finish().ok()?))
}

fn unpacked(packed: &str) -> Option<Payload> {
    let bytes = URL_SAFE_NO_PAD.decode(packed.trim_end()).ok()?;
    let mut payload = Vec::new();
    DeflateDecoder::new(&bytes[..]).take(MAX_PAYLOAD as u64 + 1).read_to_end(&mut payload).ok()?;
    if payload.len() > MAX_PAYLOAD {
        return None;
    }
    serde_json::from_slice(&payload).ok()
}
