//! Pages that are one HTML file: how they begin and end, their colours, and the texts in them.

use geometry::names::on_one_line;

/// Colours of both themes, and what all pages have. Texts have a contrast of at least 4.5 to 1 against what is behind them.
const STYLE: &str = "
:root { color-scheme: light dark; --ink: #24272c; --dim: #5a616b; --back: #f7f7f5; --card: #ffffff; --line: #dcdcd7;
  --good: #1f6f43; --bad: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e4e0; --dim: #a3a9b2; --back: #1d1f23; --card: #26292e;
  --line: #3a3e45; --good: #7fce9f; --bad: #ff9f94; } }
body { margin: 2rem auto; max-width: 72rem; padding: 0 1rem; color: var(--ink); font: 16px/1.5 system-ui, sans-serif; }
figure { margin: 0; } figcaption { color: var(--dim); } img { height: auto; }
td, th { padding: 0.1rem 1rem 0.1rem 0; text-align: left; vertical-align: top; font-weight: normal; } th { color: var(--dim); }
.passed { color: var(--good); } .failed { color: var(--bad); }";

/// The end of a page.
pub const END: &str = "</body>\n</html>\n";

/// A page up to its body, with a title, which is HTML already, and with rules of its own behind those of all pages.
pub fn begin(title: &str, style: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <style>{STYLE}{style}</style>\n</head>\n<body>\n"
    )
}

/// A text on one line, as HTML.
pub fn escaped(text: &str) -> String {
    let plain = on_one_line(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    plain.replace('"', "&quot;").replace('\'', "&#39;")
}
