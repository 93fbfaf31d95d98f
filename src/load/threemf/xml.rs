//! Reads the tags of a part in XML, within limits on their length and depth. Namespaces are left aside: where a tag stands says
//! what it means.

use std::borrow::Cow;
use std::io::{BufRead, BufReader, Read};

use quick_xml::Error;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

use super::broken;
use crate::read_error::ReadError;

/// How deep elements may be nested.
const MAX_DEPTH: usize = 256;

/// The greatest length of a tag, or of a text between tags, in bytes.
const MAX_LENGTH: u64 = 1 << 22;

/// How many bytes are unpacked at a time.
const PIECE: usize = 1 << 16;

/// An opening tag.
pub(super) struct Element<'e>(BytesStart<'e>);

impl Element<'_> {
    /// The name without its prefix.
    pub(super) fn name(&self) -> &[u8] {
        self.0.local_name().into_inner()
    }

    /// The attributes with their whole names, up to the first that can't be read.
    pub(super) fn attributes(&self) -> impl Iterator<Item = (&[u8], Cow<'_, [u8]>)> {
        let mut all = self.0.attributes();
        all.with_checks(false);
        all.map_while(Result::ok).map(|attribute| (attribute.key.into_inner(), attribute.value))
    }

    /// The attribute with this name, after a prefix or without one.
    pub(super) fn attribute(&self, name: &[u8]) -> Option<Cow<'_, [u8]>> {
        let is = |key: &[u8]| key.rsplit(|byte| *byte == b':').next() == Some(name);
        self.attributes().find(|(key, _)| is(key)).map(|(_, value)| value)
    }

    /// The same as a text.
    pub(super) fn text(&self, name: &[u8]) -> Option<String> {
        let value = self.attribute(name)?;
        let text = String::from_utf8_lossy(&value);
        let unescaped = quick_xml::escape::unescape(&text).map(Cow::into_owned);
        Some(unescaped.unwrap_or_else(|_| text.clone().into_owned()))
    }

    /// The same as a number; none also if it isn't one.
    pub(super) fn number(&self, name: &[u8]) -> Option<u32> {
        std::str::from_utf8(&self.attribute(name)?).ok()?.trim().parse().ok()
    }
}

/// Calls `take` with every opening tag of the part called `part`, and with none for a closing one, and with how many bytes have been read.
/// An element without content opens and closes.
///
/// # Errors
/// [`ReadError::Broken`], and the errors of `take`.
pub(super) fn walk(
    part: &str,
    bytes: impl Read,
    mut take: impl FnMut(Option<Element>, u64) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    // One byte more, so that what is too long is told from what ends there.
    let mut limited = BufReader::with_capacity(PIECE, bytes).take(MAX_LENGTH + 1);
    let start = limited.fill_buf().map_err(|error| broken(part, error))?;
    if matches!(start, [0xff, 0xfe, ..] | [0xfe, 0xff, ..]) {
        return Err(broken(part, "its XML is in UTF-16, but only UTF-8 is read"));
    }
    let mut reader = Reader::from_reader(limited);
    let (mut buffer, mut depth) = (Vec::new(), 0);
    loop {
        buffer.clear();
        reader.get_mut().set_limit(MAX_LENGTH + 1);
        let event = reader.read_event_into(&mut buffer);
        let event = event.map_err(|error| broken(part, said(&error)));
        let at = reader.buffer_position();
        if reader.get_ref().limit() == 0 {
            return Err(broken(part, format!("it has a tag or a text of more than {MAX_LENGTH} bytes")));
        }
        match event? {
            Event::Start(start) => {
                depth += 1;
                if depth > MAX_DEPTH {
                    return Err(broken(part, format!("its elements are nested more than {MAX_DEPTH} deep")));
                }
                take(Some(Element(start)), at)?;
            }
            Event::Empty(start) => {
                take(Some(Element(start)), at)?;
                take(None, at)?;
            }
            Event::End(_) => {
                depth -= 1;
                take(None, at)?;
            }
            Event::Eof if depth > 0 => return Err(broken(part, "its XML ends within an element")),
            Event::Eof => return Ok(()),
            _ => {}
        }
    }
}

/// Returns what an error means, without texts of the file.
fn said(error: &Error) -> String {
    match error {
        Error::Io(error) => error.to_string(),
        _ => "its XML isn't well-formed".to_owned(),
    }
}
