//! Errors.
use crate::sys;
use std::ffi::{CStr, CString};
use std::fmt;
use std::os::raw::c_char;

type Source = Box<dyn std::error::Error + Send + Sync>;

/// A call was not done: the status of C, and the library's sentence.
#[derive(Debug)]
pub struct Error {
    status: i32,
    text: String,
    source: Option<Source>,
}

impl Error {
    /// An error of the layer itself.
    pub(crate) fn new(status: i32, text: impl Into<String>) -> Self {
        Error { status, text: text.into(), source: None }
    }
    pub(crate) fn with_source(mut self, source: Option<Source>) -> Self {
        self.source = source;
        self
    }
    pub(crate) fn argument(text: impl Into<String>) -> Self {
        Error::new(sys::MPM_E_ARG, text)
    }

    /// One of the status constants: below 0 if the call was refused or failed, above 0 if it was not done.
    pub fn status(&self) -> i32 {
        self.status
    }
    /// The name of the status.
    pub fn name(&self) -> &'static str {
        // SAFETY: the text is static.
        unsafe { CStr::from_ptr(sys::mpm_status_name(self.status)) }.to_str().unwrap_or("unknown status")
    }
    /// Whether a smaller dt may cure it: statuses 1 to 5.
    pub fn wants_smaller_step(&self) -> bool {
        (1..=5).contains(&self.status)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.text.is_empty() {
            return out.write_str(&self.text);
        }
        // SAFETY: the text is static.
        out.write_str(&text_of(unsafe { sys::mpm_status_text(self.status) }))
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.source.as_ref().map(|source| source.as_ref() as _)
    }
}

/// A copy of a text of C; empty for NULL.
pub(crate) fn text_of(text: *const c_char) -> String {
    if text.is_null() {
        return String::new();
    }
    // SAFETY: texts of the library end with a zero.
    unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
}

/// A text for C.
pub(crate) fn c_text(text: &str) -> Result<CString, Error> {
    CString::new(text).map_err(|_| Error::argument(format!("{text:?} has a zero byte")))
}

/// Texts for C: what holds them, and pointers to them.
pub(crate) fn c_texts(texts: &[&str]) -> Result<(Vec<CString>, Vec<*const c_char>), Error> {
    let held = texts.iter().map(|text| c_text(text)).collect::<Result<Vec<_>, _>>()?;
    let pointers = held.iter().map(|text| text.as_ptr()).collect();
    Ok((held, pointers))
}
