//! The surfaces of walls as they are given.

use super::config::Config;
use super::solver::Body;
use crate::error::{Error, Result};
use crate::walls::{Facet, Slip, WallMethod, check_planes};

/// The surface of a wall.
#[derive(Clone, Debug)]
pub struct SurfaceInput {
    /// The name of the wall.
    pub body: String,
    /// Corners of its facets in m, flattened: two of a segment in 2D, with the fluid to the right of the way from the
    /// first to the second; three of a triangle in 3D, anticlockwise as the fluid sees them. Facets without extent are
    /// left out.
    pub corners: Vec<f64>,
}

/// Checks that surfaces belong to walls, and that there is one for a method that needs it.
pub(super) fn check_surfaces(
    config: &Config,
    bodies: &[Body],
    surfaces: &[SurfaceInput],
) -> Result<()> {
    let per_facet = config.dimension * config.dimension;
    for surface in surfaces {
        if !bodies.iter().any(|b| b.name == surface.body && !b.fluid) {
            return Err(Error::Input(format!(
                "surfaces: found one of {:?}, allowed are the names of walls",
                surface.body
            )));
        }
        if surface.corners.len() % per_facet != 0 || surface.corners.iter().any(|x| !x.is_finite())
        {
            return Err(Error::Input(format!(
                "surfaces: that of {:?} has {} numbers, allowed are {per_facet} finite ones per facet",
                surface.body,
                surface.corners.len()
            )));
        }
    }
    if let Some(wall) = config.wall.filter(|w| !w.method.uses_particles()) {
        if let Some(motion) = config.motion.first() {
            return Err(Error::Input(format!(
                "motion: found one of {:?}, but the wall method {:?} has walls at rest only; use adami, dynamic or \
                 modified-dynamic walls",
                motion.body, wall.method
            )));
        }
        if wall.method == WallMethod::Penalty && wall.slip == Slip::No {
            return Err(Error::Input(
                "wall.slip: found \"no\", but contact by penalty has no friction; let the fluid slip, or use another wall \
                 method"
                    .to_owned(),
            ));
        }
    }
    if let Some(wall) = config.wall.filter(|w| w.method.needs_surface())
        && let Some(bare) = bodies
            .iter()
            .find(|b| !b.fluid && !surfaces.iter().any(|s| s.body == b.name))
    {
        return Err(Error::Input(format!(
            "surfaces: wall {:?} has none, which the wall method {:?} needs; give its facets",
            bare.name, wall.method
        )));
    }
    Ok(())
}

/// Checks that walls which mirror are made of planes that can.
pub(super) fn check_mirrors<const D: usize>(
    config: &Config,
    bodies: &[Body],
    facets: &[Facet<D>],
) -> Result<()> {
    if config.wall.is_none_or(|w| w.method != WallMethod::Mirror) {
        return Ok(());
    }
    let support = config.smoothing_length * config.kernel.support();
    check_planes(facets, support, config.spacing).map_err(|(wall, why)| {
        let body = bodies.iter().filter(|b| !b.fluid).nth(wall as usize);
        Error::Input(format!(
            "wall.method: found \"mirror\", but wall {:?} {why}; allowed are planes at right angles, plates and gaps no \
             thinner than the support: use adami or modified-dynamic walls",
            body.map_or("", |b| &b.name)
        ))
    })
}

/// The facets of all surfaces.
pub(super) fn facets<const D: usize>(bodies: &[Body], surfaces: &[SurfaceInput]) -> Vec<Facet<D>> {
    let mut found = Vec::new();
    for surface in surfaces {
        let walls = bodies.iter().filter(|b| !b.fluid);
        let body = walls.map(|b| &b.name).position(|n| *n == surface.body);
        for corners in surface.corners.chunks_exact(D * D) {
            let corners = std::array::from_fn(|k| std::array::from_fn(|a| corners[k * D + a]));
            found.extend(Facet::new(corners, body.unwrap_or(0) as u32));
        }
    }
    found
}
