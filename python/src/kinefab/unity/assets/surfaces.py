"""Surfaces as Unity's materials."""

from __future__ import annotations

from ...model import Combine, PhysicsMaterial, Surface
from ..scene import Material
from ..scene import PhysicsMaterial as UnityPhysicsMaterial

COMBINE = {
    Combine.AVERAGE: "Average",
    Combine.MINIMUM: "Minimum",
    Combine.MULTIPLY: "Multiply",
    Combine.MAXIMUM: "Maximum",
}


def map_surface(surface: Surface) -> Material:
    return Material(
        surface.name,
        surface.color,
        surface.metallic,
        surface.smoothness,
        surface.blending,
        surface.alpha_cutoff,
        surface.double_sided,
        surface.emission,
        surface.color_texture,
        surface.normal_texture,
        surface.metallic_roughness_texture,
        surface.occlusion_texture,
        surface.emission_texture,
    )


def map_physics_material(material: PhysicsMaterial) -> UnityPhysicsMaterial:
    return UnityPhysicsMaterial(
        material.name,
        material.dynamic_friction,
        material.static_friction,
        material.restitution,
        COMBINE[material.friction_combine],
        COMBINE[material.restitution_combine],
    )
