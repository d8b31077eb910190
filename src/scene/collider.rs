//! The keys of a collider.

use super::json::{Phi, some};
use super::number::{Number, Pair};
use super::object::Object;
use crate::geom::Vec2;
use crate::num::{Density, Friction, Length, Restitution};
use crate::shape::{ColliderDef, Filter, Shape};
use serde::Deserialize;
use serde::de::{Deserializer, Error};

/// A collider that is accepted.
pub(super) struct ColliderJson(pub(super) ColliderDef);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Keys {
    #[serde(default, rename = "box", deserialize_with = "rectangle")]
    rectangle: Option<Shape>,
    #[serde(default, deserialize_with = "polygon")]
    polygon: Option<Shape>,
    #[serde(default, deserialize_with = "circle")]
    circle: Option<Shape>,
    #[serde(default)]
    offset: Pair<Length>,
    #[serde(default)]
    angle: Phi,
    #[serde(default, deserialize_with = "some")]
    density: Option<Number<Density>>,
    #[serde(default)]
    restitution: Number<Restitution>,
    #[serde(default, deserialize_with = "some")]
    friction: Option<Number<Friction>>,
    #[serde(default, deserialize_with = "some")]
    filter: Option<Object<FilterJson>>,
    #[serde(default)]
    sensor: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FilterJson {
    #[serde(default = "category")]
    category: u32,
    #[serde(default = "mask")]
    mask: u32,
}

fn category() -> u32 {
    Filter::default().category
}

fn mask() -> u32 {
    Filter::default().mask
}

impl<'de> Deserialize<'de> for ColliderJson {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Object(keys): Object<Keys> = Object::deserialize(deserializer)?;
        let mut shapes = [keys.rectangle, keys.polygon, keys.circle].into_iter().flatten();
        let (Some(shape), None) = (shapes.next(), shapes.next()) else {
            return Err(D::Error::custom("a collider has exactly one of box, polygon and circle"));
        };
        let new = ColliderDef::new(shape);
        let def = ColliderDef {
            offset: keys.offset.0,
            angle: keys.angle.0,
            density: keys.density.map_or(new.density, |density| density.0),
            restitution: keys.restitution.0,
            friction: keys.friction.map_or(new.friction, |friction| friction.0),
            filter: keys.filter.map_or(new.filter, |Object(FilterJson { category, mask })| Filter { category, mask }),
            sensor: keys.sensor,
            ..new
        };
        def.check().map_err(D::Error::custom)?;
        Ok(ColliderJson(def))
    }
}

/// A form, refused at its own key rather than at the collider.
fn form<E: Error>(shape: Shape) -> Result<Option<Shape>, E> {
    let def = ColliderDef::new(shape);
    def.check().map_err(E::custom)?;
    Ok(Some(def.shape))
}

fn rectangle<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Shape>, D::Error> {
    let Pair(Vec2 { x: width, y: height }) = Pair::deserialize(deserializer)?;
    form(Shape::Box { width, height })
}

fn polygon<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Shape>, D::Error> {
    let vertices: Vec<Pair<Length>> = Vec::deserialize(deserializer)?;
    form(Shape::Polygon { vertices: vertices.into_iter().map(|vertex| vertex.0).collect() })
}

fn circle<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Shape>, D::Error> {
    let Number(radius) = Number::deserialize(deserializer)?;
    form(Shape::Circle { radius })
}
