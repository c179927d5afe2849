//! Arbitrary output variables: what else a pixel's centre ray knows.

/// One arbitrary output variable. Taken from the ray through the pixel's centre, where it first hits what has
/// any opacity; never averaged, unclamped, not touched by exposure. 0 where the ray hits nothing, unless said
/// otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Aov {
    /// Distance along the ray, scene units; +∞ where nothing was hit.
    Depth,
    /// Shading normal in world space, facing the ray, unit.
    Normal,
    /// The point hit, in world space.
    Position,
    /// The diffuse colour of the surface, linear, without `k_d`.
    Albedo,
    /// Surface coordinates.
    Uv,
    /// Number of the object, from 1.
    Object,
    /// Number of the material, from 1.
    Material,
    /// Share of the lights that are seen, in [0, 1]; a light below the horizon is not seen.
    Shadow,
    /// Share of the ambient light that finds its way to the surface, in [0, 1]; 1 in a scene without
    /// ambient occlusion.
    Openness,
    /// Nodes visited by the centre ray: the one thing that may differ between SIMD levels.
    Cost,
}

impl Aov {
    /// Every one, in the order of the documentation.
    pub const ALL: [Self; 10] = [
        Self::Depth,
        Self::Normal,
        Self::Position,
        Self::Albedo,
        Self::Uv,
        Self::Object,
        Self::Material,
        Self::Shadow,
        Self::Openness,
        Self::Cost,
    ];

    /// The name used on the command line and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::Position => "position",
            Self::Albedo => "albedo",
            Self::Uv => "uv",
            Self::Object => "object",
            Self::Material => "material",
            Self::Shadow => "shadow",
            Self::Openness => "openness",
            Self::Cost => "cost",
        }
    }

    /// The variable of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|aov| aov.name() == name)
    }

    /// Values a pixel: 1, 2 or 3.
    pub const fn channels(self) -> usize {
        match self {
            Self::Normal | Self::Position | Self::Albedo => 3,
            Self::Uv => 2,
            Self::Depth
            | Self::Object
            | Self::Material
            | Self::Shadow
            | Self::Openness
            | Self::Cost => 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_leads_back_to_its_variable() {
        for aov in Aov::ALL {
            assert_eq!(Aov::from_name(aov.name()), Some(aov));
        }
        assert_eq!(Aov::from_name("depht"), None);
    }
}
