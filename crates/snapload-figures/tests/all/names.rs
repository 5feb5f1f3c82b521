//! The names beside dots.

use snapload_figures::{Axis, Layer, Mark, Plot, Point, Range, Stroke, Width, draw};

/// The numbers of an attribute of all elements with a name, in their order.
fn numbers(document: &roxmltree::Document, name: &str, keys: [&str; 2]) -> Vec<(Point, String)> {
    let nodes = document.descendants().filter(|node| {
        node.has_tag_name(name)
            && node.attribute("text-anchor").is_none()
            && node.attribute(keys[0]).is_some()
    });
    let number =
        |node: &roxmltree::Node, key| node.attribute(key).and_then(|text| text.parse().ok());
    nodes
        .filter_map(|node| {
            let at = [number(&node, keys[0])?, number(&node, keys[1])?];
            Some((at, node.text().unwrap_or_default().to_owned()))
        })
        .collect()
}

/// Along a rising line two special points lie close to each other, as the doubling and the corner
/// of a branch do. A name that stood nearer to the other's dot would be taken for its name.
#[test]
fn each_name_is_nearest_to_its_own_dot() {
    for apart in [0.05, 0.06, 0.07, 0.0867, 0.1, 0.12] {
        let marks = [
            ("corner", [1.68 + apart, 0.248 + 0.2 * apart]),
            ("doubling", [1.68, 0.248]),
        ];
        let dots = marks.map(|(_, at)| at);
        let line = vec![[1.4, 0.17], [1.5, 0.205], dots[1], dots[0]];
        let plot = Plot {
            x: Axis::new("", Range::Fixed(1.2, 4.1)),
            y: Axis::new("", Range::Fixed(0.14, 0.99)),
            layers: vec![
                Layer::Line(vec![line], Stroke::default(), String::new()),
                Layer::Letters(marks.map(|(name, at)| Mark::new(name, at)).to_vec()),
            ],
            ..Plot::default()
        };
        let picture = draw("test", Width::Page, &[plot]).expect("one panel can be drawn");
        let document = roxmltree::Document::parse(picture.svg()).expect("the picture is XML");
        let dots = numbers(&document, "circle", ["cx", "cy"]);
        let names = numbers(&document, "text", ["x", "y"]);
        for (own, (name, _)) in marks.iter().enumerate() {
            let (corner, _) = names
                .iter()
                .find(|(_, text)| text == name)
                .expect("its name");
            // Letters are half as wide as they are high, and capitals three quarters of that.
            let [right, top] = [corner[0] + 3.5 * name.len() as f64, corner[1] - 5.0];
            let distance = |[x, y]: Point| {
                let across = x - x.clamp(corner[0], right);
                across.hypot(y - y.clamp(top, corner[1]))
            };
            let [here, there] = [own, 1 - own].map(|k| distance(dots[k].0));
            assert!(
                here < there,
                "{apart} {name}: {here} from its dot, {there} from the other"
            );
        }
    }
}
