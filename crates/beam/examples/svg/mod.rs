//! Lines in a frame, as SVG: all that these examples draw.

/// One line: its name and its points.
pub(crate) type Line = (String, Vec<[f64; 2]>);

const COLOURS: [&str; 6] = ["#1f5fa8", "#c4452d", "#3a8f4d", "#8a5aa8", "#c08a1e", "#555555"];

/// Inner size and margins, px.
const SIZE: [f64; 2] = [640.0, 300.0];
const MARGIN: [f64; 2] = [80.0, 40.0];

/// A page with these lines, their axes marked at round numbers.
pub(crate) fn plot(title: &str, axes: [&str; 2], lines: &[Line]) -> String {
    let all = || lines.iter().flat_map(|(_, points)| points);
    let range: [[f64; 2]; 2] = [0, 1].map(|i| {
        let start = [f64::INFINITY, f64::NEG_INFINITY];
        all().fold(start, |[low, high], point| [low.min(point[i]), high.max(point[i])])
    });
    let place = |i: usize, value: f64| {
        let part = (value - range[i][0]) / (range[i][1] - range[i][0]);
        MARGIN[i] + SIZE[i] * if i == 0 { part } else { 1.0 - part }
    };
    let (width, height) = (SIZE[0] + 2.0 * MARGIN[0] + 60.0, SIZE[1] + 2.0 * MARGIN[1] + 30.0);
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} {height}' font-family='sans-serif' font-size='13'>\n\
         <rect width='100%' height='100%' fill='white'/>\n<text x='{}' y='24' font-size='15'>{title}</text>\n",
        MARGIN[0]
    );
    let mut add = |text: String| svg.push_str(&(text + "\n"));
    let [left, right] = [MARGIN[0], MARGIN[0] + SIZE[0]];
    let [top, bottom] = [MARGIN[1], MARGIN[1] + SIZE[1]];
    for mark in marks(range[0]) {
        let x = place(0, mark);
        add(format!("<path d='M{x:.1} {top} V{bottom}' stroke='#ddd'/>"));
        add(format!("<text x='{x:.1}' y='{}' text-anchor='middle'>{}</text>", bottom + 18.0, tidy(mark)));
    }
    for mark in marks(range[1]) {
        let (y, colour) = (place(1, mark), if mark == 0.0 { "#888" } else { "#ddd" });
        add(format!("<path d='M{left} {y:.1} H{right}' stroke='{colour}'/>"));
        add(format!("<text x='{}' y='{:.1}' text-anchor='end'>{}</text>", left - 8.0, y + 4.0, tidy(mark)));
    }
    add(format!("<text x='{right}' y='{}' text-anchor='end'>{}</text>", bottom + 38.0, axes[0]));
    add(format!("<text transform='translate(18 {top}) rotate(-90)' text-anchor='end'>{}</text>", axes[1]));
    for (k, (name, points)) in lines.iter().enumerate() {
        let colour = COLOURS[k % COLOURS.len()];
        let path: Vec<String> =
            points.iter().map(|point| format!("{:.1},{:.1}", place(0, point[0]), place(1, point[1]))).collect();
        add(format!("<polyline points='{}' fill='none' stroke='{colour}' stroke-width='1.8'/>", path.join(" ")));
        let y = top + 16.0 * (k as f64 + 0.5);
        add(format!("<text x='{}' y='{y}' fill='{colour}'>{name}</text>", right + 10.0));
    }
    svg + "</svg>\n"
}

/// Round numbers inside a range: steps of 1, 2 or 5 times a power of ten.
fn marks([low, high]: [f64; 2]) -> Vec<f64> {
    let rough = (high - low) / 8.0;
    let decade = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|unit| unit * decade).into_iter().find(|step| *step >= rough).unwrap_or(rough);
    let first = (low / step - 1e-9).ceil() as i64;
    (first..).map(|k| k as f64 * step).take_while(|mark| *mark <= high + 1e-9 * step).collect()
}

fn tidy(mark: f64) -> String {
    let text = format!("{mark:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
