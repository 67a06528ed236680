//! Where nodes and edges lie: layers from top to bottom, laid out by a library.

use std::collections::BTreeMap;

use layout::core::base::Orientation;
use layout::core::format::{ClipHandle, RenderBackend};
use layout::core::geometry::{Point, Position};
use layout::core::style::StyleAttr;
use layout::std_shapes::shapes::{Arrow, Element, ShapeKind};
use layout::topo::layout::VisualGraph;

/// A point in pixels.
pub(super) type At = (f64, f64);

/// The places of everything.
#[derive(Debug, Default)]
pub(super) struct Layout {
    /// Upper left corner and size of each node.
    pub(super) nodes: BTreeMap<usize, (At, At)>,
    /// The ways of the edges: start and pairs of a control point and a point, as they were drawn.
    pub(super) edges: Vec<Way>,
    /// Middle of the words of an edge, by its number.
    pub(super) words: BTreeMap<usize, At>,
}

/// The way of an edge.
#[derive(Debug)]
pub(super) struct Way {
    /// Number in the list that was laid out.
    pub(super) edge: usize,
    /// A point where the line passes and the point towards which it leaves.
    pub(super) path: Vec<(At, At)>,
    /// The arrow head stands at the beginning.
    pub(super) reversed: bool,
}

/// An edge to be laid out, from one node to another.
pub(super) struct Line {
    pub(super) from: usize,
    pub(super) to: usize,
    /// Characters in a line and number of lines of the words on it; no lines for none.
    pub(super) words: (usize, usize),
}

/// Width of a character of the words on an edge; their lines are twice as high.
const LETTER: usize = 6;
/// Space around a node.
const HALO: f64 = 26.0;

/// Lays out nodes of these sizes and the edges between them.
pub(super) fn lay_out(sizes: &[At], edges: &[Line]) -> Layout {
    let mut look = StyleAttr::simple();
    look.font_size = LETTER;
    let mut visual = VisualGraph::new(Orientation::TopToBottom);
    let mut handles = Vec::new();
    for (n, (width, height)) in sizes.iter().enumerate() {
        let size = Point::new(*width, *height);
        let shape = ShapeKind::new_box("");
        let orientation = Orientation::TopToBottom;
        let mut node =
            Element::create_with_properties(shape, look.clone(), orientation, size, n.to_string());
        node.pos = Position::new(Point::zero(), size, Point::zero(), Point::splat(HALO));
        handles.push(visual.add_node(node));
    }
    for (n, line) in edges.iter().enumerate() {
        // The library needs words only for their size; the number of the edge comes back where they would be drawn.
        let (width, count) = line.words;
        let words = vec![format!("{n:<width$}"); count * 2].join("\n");
        let mut arrow = Arrow::simple_with_properties(&words, n.to_string());
        arrow.look = look.clone();
        visual.add_edge(arrow, handles[line.from], handles[line.to]);
    }
    let mut layout = Layout::default();
    visual.do_it(false, false, false, &mut layout);
    layout
}

fn at(point: Point) -> At {
    (point.x, point.y)
}

/// Collects what the library would draw.
impl RenderBackend for Layout {
    fn draw_rect(
        &mut self,
        xy: Point,
        size: Point,
        _: &StyleAttr,
        properties: Option<String>,
        _: Option<ClipHandle>,
    ) {
        if let Some(n) = properties.and_then(|p| p.parse().ok()) {
            self.nodes.insert(n, (at(xy), at(size)));
        }
    }

    fn draw_line(&mut self, _: Point, _: Point, _: &StyleAttr, _: Option<String>) {}

    fn draw_circle(&mut self, _: Point, _: Point, _: &StyleAttr, _: Option<String>) {}

    fn draw_text(&mut self, xy: Point, text: &str, _: &StyleAttr) {
        let number = text.lines().next().map(str::trim);
        if let Some(edge) = number.and_then(|n| n.parse().ok()) {
            self.words.insert(edge, at(xy));
        }
    }

    fn draw_arrow(
        &mut self,
        path: &[(Point, Point)],
        _: bool,
        head: (bool, bool),
        _: &StyleAttr,
        properties: Option<String>,
        _: &str,
    ) {
        if let Some(edge) = properties.and_then(|p| p.parse().ok()) {
            self.edges.push(Way {
                edge,
                path: path.iter().map(|(a, b)| (at(*a), at(*b))).collect(),
                reversed: head.0,
            });
        }
    }

    fn create_clip(&mut self, _: Point, _: Point, _: usize) -> ClipHandle {
        0
    }
}
