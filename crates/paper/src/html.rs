//! The pieces of HTML that the page is made of.

use super::figures::Picture;

/// Text as HTML wants it.
pub(super) fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// A paragraph of plain text.
pub(super) fn paragraph(text: &str) -> String {
    format!("<p>{}</p>\n", escape(text))
}

/// A list of plain texts.
pub(super) fn list(items: &[String]) -> String {
    let items: String = items
        .iter()
        .map(|item| format!("  <li>{}</li>\n", escape(item)))
        .collect();
    format!("<ul>\n{items}</ul>\n")
}

/// Renderer side by side where there is room; `class` may ask for narrower ones.
pub(super) fn pictures(pictures: &[Picture], class: &str) -> String {
    let figures: String = pictures.iter().map(|picture| figure(picture, "")).collect();
    format!("<div class=\"pictures{class}\">\n{figures}</div>\n")
}

/// One picture with its caption.
pub(super) fn figure(picture: &Picture, class: &str) -> String {
    let (file, alt, caption) = (
        &picture.file,
        escape(&picture.alt),
        escape(&picture.caption),
    );
    // As wide as page.css takes a page for a phone's.
    let narrow = picture.narrow.as_ref().map_or_else(String::new, |narrow| {
        format!("<source media=\"(max-width: 52rem)\" srcset=\"{narrow}\">")
    });
    format!(
        "<figure{class}><a href=\"{file}\"><picture>{narrow}<img src=\"{file}\" alt=\"{alt}\" loading=\"lazy\">\
         </picture></a><figcaption>{caption}</figcaption></figure>\n"
    )
}

/// A picture as wide as the page.
pub(super) fn wide(picture: &Picture) -> String {
    figure(picture, " class=\"wide\"")
}

/// A table from cells that are HTML already. Rows stand in groups; the first cell of a row is its header.
pub(super) fn table(id: &str, caption: &str, header: &str, groups: &[Vec<Vec<String>>]) -> String {
    let mut body = String::new();
    for group in groups {
        body.push_str("<tbody>\n");
        for (index, row) in group.iter().enumerate() {
            body.push_str(if index > 0 {
                "<tr class=\"again\">"
            } else {
                "<tr>"
            });
            for (column, cell) in row.iter().enumerate() {
                if column == 0 {
                    body.push_str(&format!("<th scope=\"row\">{cell}</th>"));
                } else if cell.starts_with("<td") {
                    body.push_str(cell);
                } else {
                    body.push_str(&format!("<td>{cell}</td>"));
                }
            }
            body.push_str("</tr>\n");
        }
        body.push_str("</tbody>\n");
    }
    let caption = escape(caption);
    format!(
        "<div class=\"scroll\"><table id=\"{id}\">\n<caption>{caption}</caption>\n<thead>\n{header}</thead>\n\
         {body}</table></div>\n"
    )
}

/// A header row of plain texts; `words` are the columns that hold text rather than numbers.
pub(super) fn header(cells: &[&str], words: &[usize]) -> String {
    let cell = |(column, cell): (usize, &&str)| {
        let class = if words.contains(&column) {
            " class=\"words\""
        } else {
            ""
        };
        format!("<th scope=\"col\"{class}>{}</th>", escape(cell))
    };
    format!(
        "<tr>{}</tr>\n",
        cells.iter().enumerate().map(cell).collect::<String>()
    )
}

/// A section with its heading.
pub(super) fn section(id: &str, title: &str, content: &str) -> String {
    format!(
        "<section id=\"{id}\">\n<h2>{}</h2>\n{content}</section>\n",
        escape(title)
    )
}

/// What agrees with the paper, what does not, and why.
pub(super) struct Findings {
    pub(super) agrees: String,
    pub(super) differs: String,
    pub(super) why: String,
}

/// Findings as a list of definitions.
pub(super) fn findings(findings: &Findings) -> String {
    let entry = |term: &str, text: &str| format!("  <dt>{term}</dt><dd>{}</dd>\n", escape(text));
    let Findings {
        agrees,
        differs,
        why,
    } = findings;
    let entries = [
        entry("Agrees", agrees),
        entry("Differs", differs),
        entry("Why", why),
    ]
    .concat();
    format!("<dl class=\"findings\">\n{entries}</dl>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped() {
        assert_eq!(escape(r#"a < b & "c""#), "a &lt; b &amp; &quot;c&quot;");
    }
}
