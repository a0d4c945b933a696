//! The objects of a PDF file.

use super::content::Content;
use super::font::Font;

/// A file of one page of this size in points; `None` if the font is broken.
pub(super) fn write(content: Content<'_>, font: &Font, [width, height]: [f64; 2], title: &str) -> Option<Vec<u8>> {
    let glyphs = font.file()?;
    let opacities = content.opacities.iter().enumerate().map(|(number, opacity)| {
        let [fill, stroke] = opacity.map(|part| f64::from(part) / 1000.0);
        format!("/G{number} << /ca {fill} /CA {stroke} >> ")
    });
    let opacities: String = opacities.collect();
    let title: String = title.encode_utf16().map(|unit| format!("{unit:04x}")).collect();
    let name = "TEETER+Arimo";
    let mut file = File::default();
    file.object("<< /Type /Catalog /Pages 2 0 R >>");
    file.object("<< /Type /Pages /Kids [3 0 R] /Count 1 >>");
    file.object(&format!(
        "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width:.3} {height:.3}] /Contents 4 0 R /Resources << /Font << /F1 5 0 R >> \
         /ExtGState << {opacities}>> >> >>"
    ));
    file.stream("", content.operators.as_bytes());
    file.object(&format!(
        "<< /Type /Font /Subtype /Type0 /BaseFont /{name} /Encoding /Identity-H /DescendantFonts [6 0 R] /ToUnicode 9 0 R >>"
    ));
    file.object(&format!(
        "<< /Type /Font /Subtype /CIDFontType2 /BaseFont /{name} /CIDSystemInfo << /Registry (Adobe) /Ordering (Identity) \
         /Supplement 0 >> /FontDescriptor 7 0 R /CIDToGIDMap /Identity /W [{}] >>",
        font.widths()
    ));
    file.object(&format!("<< /Type /FontDescriptor /FontName /{name} {} /FontFile2 8 0 R >>", font.descriptor()));
    file.stream(&format!("/Length1 {} ", glyphs.len()), &glyphs);
    file.stream("", font.to_unicode().as_bytes());
    file.object(&format!("<< /Title <feff{title}> /Producer (teeter) >>"));
    Some(file.end())
}

/// A file as far as it is written.
struct File {
    bytes: Vec<u8>,
    /// Where each object starts.
    starts: Vec<usize>,
}

impl Default for File {
    fn default() -> Self {
        // Bytes beyond ASCII, by which programs see that it is no text.
        Self { bytes: b"%PDF-1.7\n%\xe2\xe3\xcf\xd3\n".to_vec(), starts: Vec::new() }
    }
}

impl File {
    fn object(&mut self, text: &str) {
        self.begin();
        self.bytes.extend_from_slice(text.as_bytes());
        self.bytes.extend_from_slice(b"\nendobj\n");
    }

    fn stream(&mut self, entries: &str, data: &[u8]) {
        let packed = miniz_oxide::deflate::compress_to_vec_zlib(data, 9);
        self.begin();
        let head = format!("<< {entries}/Length {} /Filter /FlateDecode >>\nstream\n", packed.len());
        self.bytes.extend_from_slice(head.as_bytes());
        self.bytes.extend_from_slice(&packed);
        self.bytes.extend_from_slice(b"\nendstream\nendobj\n");
    }

    fn begin(&mut self) {
        self.starts.push(self.bytes.len());
        let number = self.starts.len();
        self.bytes.extend_from_slice(format!("{number} 0 obj\n").as_bytes());
    }

    fn end(mut self) -> Vec<u8> {
        let (start, count) = (self.bytes.len(), self.starts.len() + 1);
        let mut table = format!("xref\n0 {count}\n0000000000 65535 f \n");
        self.starts.iter().for_each(|start| table.push_str(&format!("{start:010} 00000 n \n")));
        table.push_str(&format!(
            "trailer\n<< /Size {count} /Root 1 0 R /Info {} 0 R >>\nstartxref\n{start}\n%%EOF\n",
            count - 1
        ));
        self.bytes.extend_from_slice(table.as_bytes());
        self.bytes
    }
}
