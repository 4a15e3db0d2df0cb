"""What an SDF file holds that has no place in a scene, or misspells: left out by name."""

from __future__ import annotations

from ...diagnostics import Report
from ..robots.unread import Children, Unread, children

AXIS = children(one="xyz dynamics limit mimic use_parent_model_frame initial_position")
MAPS = (
    "roughness_map metalness_map ambient_occlusion_map environment_map light_map glossiness_map specular_map"
)
TEXTURED = children(
    one="albedo_map normal_map emissive_map metalness roughness", foreign=f"{MAPS} glossiness"
)
GRAMMAR: dict[str, Children] = {
    "sdf": children("model include", foreign="light actor"),
    "world": children(
        "model include link joint frame",
        "gravity",
        "plugin light actor gui scene physics wind audio atmosphere magnetic_field spherical_coordinates state road "
        "population",
    ),
    "include": children(one="uri name pose static placement_frame", foreign="plugin"),
    "model": children(
        "model include link joint frame",
        "pose static self_collide allow_auto_disable",
        "plugin gripper enable_wind model_state",
    ),
    "link": children(
        "visual collision",
        "pose inertial gravity kinematic self_collide must_be_base_link",
        "frame plugin sensor light contact velocity_decay enable_wind audio_sink audio_source battery particle_emitter projector",
    ),
    "inertial": children(
        one="pose mass inertia density", foreign="frame auto_inertia_params fluid_added_mass"
    ),
    "visual": children(
        one="pose geometry material transparency",
        foreign="frame cast_shadows laser_retro visibility_flags meta plugin",
    ),
    "collision": children(
        one="pose geometry surface density", foreign="frame laser_retro max_contacts auto_inertia_params"
    ),
    "surface": children(one="friction bounce", foreign="contact soft_contact"),
    "friction": children(one="ode", foreign="torsional bullet"),
    "ode": children(one="mu mu2", foreign="fdir1 slip1 slip2"),
    "bounce": children(one="restitution_coefficient", foreign="threshold"),
    "material": children(
        one="script diffuse emissive pbr double_sided",
        foreign="ambient specular shininess shader render_order lighting",
    ),
    "pbr": children(one="metal specular"),
    "metal": TEXTURED,
    "specular": TEXTURED,
    "joint": children(
        one="parent child pose axis axis2 thread_pitch screw_thread_pitch gearbox_ratio gearbox_reference_body",
        foreign="frame physics sensor plugin",
    ),
    "axis": AXIS,
    "axis2": AXIS,
    "limit": children(one="lower upper effort velocity stiffness dissipation"),
    "dynamics": children(one="spring_stiffness spring_reference damping friction"),
    "mimic": children(one="multiplier offset reference"),
}
IN_WORLD = {**GRAMMAR, "sdf": children(one="world", foreign="model include light actor")}


def unread_of(has_world: bool, report: Report) -> Unread:
    """has_world: then models beside it are not read."""
    return Unread(IN_WORLD if has_world else GRAMMAR, lambda tag, inside: ":" in tag, report)
