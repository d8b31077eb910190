//! Two polygons: the edge of greatest separation, and the edge that faces it, clipped to it.
//!
//! Source: Ericson, "Real-Time Collision Detection" 5.2.1 (separating axes); Catto, "Contact Manifolds", GDC 2007
//! (reference and incident edge).

use core::cmp::Ordering;

use super::faces::{Faces, Outermost};
use super::manifold::{Manifold, Near, Point};
use super::{along, difference, next, previous, rounded, sum};
use crate::num::{clamp_i64, div, mul};
use crate::shape::Placed;

/// The two polygons as the owner of the reference edge sees them, from its own centre.
#[derive(Clone, Copy)]
struct View<'a> {
    own: &'a Placed,
    other: &'a Placed,
    /// From the own centre to the other's.
    shift: [i64; 2],
}

/// The least n·v, Q38 m, and the vertex it is at (ties: lower index).
#[inline(always)]
fn lowest(normal: [i32; 2], vertices: &[[i64; 2]]) -> (usize, i64) {
    let mut lowest = (0, i64::MAX);
    for (index, &vertex) in vertices.iter().enumerate() {
        let height = along(normal, vertex);
        lowest = if height < lowest.1 { (index, height) } else { lowest };
    }
    lowest
}

impl View<'_> {
    /// The other's vertex farthest against a normal. Four vertices are the usual number: their loop is unrolled.
    #[inline(always)]
    fn nearest(&self, normal: [i32; 2]) -> (usize, i64) {
        let vertices = &self.other.vertices[..usize::from(self.other.count)];
        match <&[[i64; 2]; 4]>::try_from(vertices) {
            Ok(four) => lowest(normal, four),
            Err(_) => lowest(normal, vertices),
        }
    }

    /// How far the other is outside an edge: its nearest vertex and its separation, Q32 m.
    #[inline(always)]
    fn separation(&self, edge: usize) -> (usize, i64) {
        let normal = self.own.normals[edge];
        let base = along(normal, difference(self.shift, self.own.vertices[edge]));
        let (nearest, height) = self.nearest(normal);
        (nearest, rounded(height.wrapping_add(base)))
    }

    /// The face of greatest separation (ties: lower index); if that is more than `limit`, a separation that is.
    ///
    /// A point in the other polygon is no farther out than its nearest vertex, so the middle of a diagonal bounds the
    /// separation from an edge: few edges need a look at all vertices. The choice is that of looking at all of them. `known`
    /// is told which one it is, and asked first.
    #[inline]
    fn greatest(&self, limit: i64, known: &mut Outermost) -> Result<Face, i64> {
        if let Some(edge) = known.known() {
            let (nearest, separation) = self.separation(edge);
            return if separation > limit { Err(separation) } else { Ok(Face { edge, nearest, separation }) };
        }
        let half = usize::from(self.other.count / 2);
        let middle = sum(self.other.vertices[0], self.other.vertices[half]).map(|c| c >> 1);
        let middle = sum(middle, self.shift);
        let count = usize::from(self.own.count).min(B);
        let mut bounds = [i64::MIN; B];
        let mut outermost = 0;
        for edge in 0..count {
            bounds[edge] = along(self.own.normals[edge], difference(middle, self.own.vertices[edge]));
            outermost = if bounds[edge] > bounds[outermost] { edge } else { outermost };
        }
        let (nearest, separation) = self.separation(outermost);
        let mut best = Face { edge: outermost, nearest, separation };
        if separation > limit {
            return Err(separation);
        }
        let mut second = i64::MIN;
        for (edge, &bound) in bounds[..count].iter().enumerate() {
            if edge == outermost {
                continue;
            }
            // Two units for the rounding of the middle and of both numbers.
            let most = rounded(bound).wrapping_add(2);
            if most < best.separation {
                second = second.max(most);
                continue;
            }
            let (nearest, separation) = self.separation(edge);
            if separation > limit {
                return Err(separation);
            }
            if separation > best.separation || separation == best.separation && edge < best.edge {
                second = second.max(best.separation);
                best = Face { edge, nearest, separation };
            } else {
                second = second.max(separation);
            }
        }
        *known = Outermost::new(best.edge, best.separation.saturating_sub(second));
        Ok(best)
    }

    /// Clips the edge that faces `edge` to it; `alone`: takes its nearest vertex instead, over the edge or not.
    #[inline(always)]
    fn clip(&self, face: Face, alone: bool) -> Clip {
        let Face { edge, nearest, .. } = face;
        let View { own, other, shift } = *self;
        let normal = own.normals[edge];
        let count = usize::from(other.count);
        // Of its two edges the one that faces the normal more.
        let facing = |edge: usize| {
            let [[x, y], [u, v]] = [normal, other.normals[edge]].map(|n| n.map(i64::from));
            x.wrapping_mul(u).wrapping_add(y.wrapping_mul(v))
        };
        let before = previous(nearest, count);
        let incident = if facing(before) < facing(nearest) { before } else { nearest };

        // From the reference edge's first vertex; 0 is its low end, 1 the high one. The incident edge runs against it.
        let origin = own.vertices[edge];
        let base = difference(shift, origin);
        let corners = [[0; 2], difference(own.vertices[next(edge, usize::from(own.count))], origin)];
        let vertices = [next(incident, count), incident].map(|index| sum(other.vertices[index], base));
        let side = usize::from(incident == nearest);
        let tangent = [normal[1].wrapping_neg(), normal[0]];
        let width = rounded(along(tangent, corners[1]));
        let mut at = vertices.map(|v| rounded(along(tangent, v)));
        let mut gaps = vertices.map(|v| rounded(along(normal, v)));
        if at[0] >= at[1] {
            // Upright, as at the tip of a needle: its nearest vertex is all that can be over the edge.
            (at, gaps) = ([at[side]; 2], [gaps[side]; 2]);
        }
        let mut overlap = [at[0].max(0), at[1].min(width)];
        let mut found = match overlap[0].cmp(&overlap[1]) {
            Ordering::Less => [true; 2],
            Ordering::Equal => [0, 1].map(|end| (end == side) == (at[side] == overlap[0])),
            Ordering::Greater => [false; 2],
        };
        if alone {
            overlap = [at[side]; 2];
            // What decided that they overlap, which may be a unit less than what one sum gives.
            gaps[side] = face.separation;
            found = [side == 0, side == 1];
        }
        // Half-way from the incident vertex back to the reference edge, or from the reference edge's vertex on to the
        // incident edge. Without branches, which nothing could predict: `between` is exact at its ends.
        let end = |end: usize| {
            let part = overlap[end].wrapping_sub(at[0]);
            let separation = between(gaps[0], gaps[1], part, at[1].wrapping_sub(at[0]));
            let back = overlap[end] == at[end];
            let from = if back { vertices[end] } else { corners[end] };
            let way = if back { separation.wrapping_neg() } else { separation };
            End { arm: sum(sum(from, origin), normal.map(|n| mul(n.into(), way, 31))), separation }
        };
        Clip { incident, ends: [end(0), end(1)], found }
    }
}

/// The most edges.
const B: usize = 8;

/// An edge, the other polygon's vertex nearest to its line (ties: lower index), and how far that is outside.
#[derive(Clone, Copy)]
struct Face {
    edge: usize,
    nearest: usize,
    separation: i64,
}

/// An end of the overlap of two edges: half-way between the surfaces, from the own centre, and the separation there.
#[derive(Clone, Copy)]
struct End {
    arm: [i64; 2],
    separation: i64,
}

struct Clip {
    incident: usize,
    /// The low and the high end, by the direction of the reference edge.
    ends: [End; 2],
    /// Which of them there are: one where the edges overlap in a point, that of the incident edge's vertex.
    found: [bool; 2],
}

/// a + (b − a)·part/whole, rounded once to nearest; 0 ≤ part ≤ whole.
#[inline]
pub(super) fn between(a: i64, b: i64, part: i64, whole: i64) -> i64 {
    let rise = b.wrapping_sub(a);
    let share = match rise.checked_mul(part) {
        // The divisor is below 2⁵²: with half of it added a magnitude is still below 2⁶⁴.
        Some(product) => {
            let whole = whole.unsigned_abs();
            let up = product.unsigned_abs().wrapping_add(whole / 2).checked_div(whole).unwrap_or(0) as i64;
            if product < 0 { up.wrapping_neg() } else { up }
        }
        None => clamp_i64(div(i128::from(rise).wrapping_mul(part.into()), whole.into())),
    };
    a.wrapping_add(share)
}

/// `boxes`: how far apart their boxes are, which is no more than the limit.
pub(super) fn near(a: &Placed, b: &Placed, d: [i64; 2], limit: i64, boxes: i64, known: &mut Faces) -> Near {
    let views = [View { own: a, other: b, shift: d }, View { own: b, other: a, shift: d.map(i64::wrapping_neg) }];
    let mut greatest = |polygon: usize| views[polygon].greatest(limit, known.of(polygon));
    let faces = greatest(0).and_then(|of_a| Ok([of_a, greatest(1)?]));
    let [of_a, of_b] = match faces {
        Ok(faces) => faces,
        Err(by) => return Near::apart(by),
    };
    // In a tie a's.
    let owner = usize::from(of_b.separation > of_a.separation);
    let face = if owner == 0 { of_a } else { of_b };
    let clip = views[owner].clip(face, false);
    let mut near = Near { apart: false, from: boxes.max(face.separation), below: i64::MAX, ..Near::default() };
    near.manifold = manifold(&views, owner, face.edge, &clip, d, (limit, &mut near));
    if near.manifold.count == 0 {
        near.manifold = otherwise(&views, owner, face, clip.found, d, (limit, &mut near));
    }
    near
}

/// The points of a clip that are within the limit; which limits would take the same of them is noted.
#[inline(always)]
fn manifold(
    views: &[View<'_>; 2],
    owner: usize,
    edge: usize,
    clip: &Clip,
    d: [i64; 2],
    (limit, near): (i64, &mut Near),
) -> Manifold {
    let edges = if owner == 0 { [edge, clip.incident] } else { [clip.incident, edge] };
    let pair = edges[0] << 4 | edges[1] << 1;
    let d = if owner == 0 { [0; 2] } else { d };
    // Where a's edge starts, the low end of its own, is the high end of b's: b's edge runs the other way.
    let point = |bit: usize| {
        let End { arm, separation } = clip.ends[bit ^ owner];
        Point { arm: sum(arm, d), separation, id: (pair | bit) as u8 }
    };
    let mut found = |bit: usize| {
        let separation = clip.ends[bit ^ owner].separation;
        if clip.found[bit ^ owner] && separation <= limit {
            near.from = near.from.max(separation);
        } else if clip.found[bit ^ owner] {
            near.below = near.below.min(separation);
        }
        clip.found[bit ^ owner] && separation <= limit
    };
    let (count, points) = match (found(0), found(1)) {
        (true, true) => (2, [point(0), point(1)]),
        (true, false) => (1, [point(0), Point::default()]),
        (false, true) => (1, [point(1), Point::default()]),
        (false, false) => return Manifold::default(),
    };
    let normal = views[owner].own.normals[edge];
    let normal = if owner == 0 { normal.map(i32::wrapping_neg) } else { normal };
    Manifold { normal, count, points }
}

/// Where the best edge has no point: if nothing is over it, the first edge as good up to rounding over which there is
/// something; else, if the polygons overlap (by no more than rounding, as far as is known), the nearest vertex alone.
///
/// Of edges nearly in line (a flat side with a vertex in it) the rounding of normals picks one, and the other outline
/// may lie over the next.
#[cold]
#[inline(never)]
fn otherwise(
    views: &[View<'_>; 2],
    owner: usize,
    face: Face,
    found: [bool; 2],
    d: [i64; 2],
    (limit, near): (i64, &mut Near),
) -> Manifold {
    let extent = |p: &Placed| (0..2).map(|axis| p.max[axis].wrapping_sub(p.min[axis])).max().unwrap_or(0);
    // A unit of 2⁻³⁰ for each of two normals and as much for the rounding of vertices, along either outline.
    let tolerance = (extent(views[0].own).max(extent(views[1].own)) >> 28).wrapping_add(4);
    let edges = |owner: usize| (0..usize::from(views[owner].own.count)).map(move |edge| (owner, edge));
    for (owner, edge) in edges(0).chain(edges(1)) {
        let (nearest, separation) = views[owner].separation(edge);
        if found == [false; 2] && separation >= face.separation.wrapping_sub(tolerance) {
            let clip = views[owner].clip(Face { edge, nearest, separation }, false);
            let beside = manifold(views, owner, edge, &clip, d, (limit, near));
            if beside.count > 0 {
                return beside;
            }
        }
    }
    if face.separation > 0 {
        return Manifold::default();
    }
    manifold(views, owner, face.edge, &views[owner].clip(face, true), d, (limit, near))
}
