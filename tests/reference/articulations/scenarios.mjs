// The articulations that are compared with PhysX 5.6.1. What a scenario says: ../README.md.
const S = Math.SQRT1_2;
const ABOUT = { x: [0, 0, 0, 1], y: [0, 0, S, S], z: [0, -S, 0, S], tilted: [0.2, 0.4, -0.4, 0.8] };
const free = { motion: "free" };
const base = (more = {}) => ({ mass: 3, inertia: [0.3, 0.2, 0.25], ...more });

// A link below another: the joint at (0.3, 0.05, 0.02) of the upper one and at (-0.3, 0.02, -0.03) of this one.
const link = (type, axis, axes, more = {}) => {
  const { parent = 0, friction, maxSpeed, at = [0.3, 0.05, 0.02], own = [-0.3, 0.02, -0.03], turned, ...body } = more;
  const rotation = ABOUT[axis];
  return {
    parent,
    mass: 2,
    inertia: [0.05, 0.12, 0.1],
    ...body,
    joint: { type, parentFrame: { position: at, rotation }, childFrame: { position: own, rotation: turned ?? rotation }, axes, friction, maxSpeed },
  };
};
const arm = (type, axis, axes, more = {}, scene = {}) => ({ ...scene, links: [base(), link(type, axis, axes, more)] });
const drive = (more) => ({ ...free, ...more });
const limited = (lower, upper, more = {}) => ({ motion: "limited", lower, upper, ...more });
const chain = (kinds, scene = {}) => ({
  ...scene,
  links: [base(), ...kinds.map(([type, axis, axes, more], i) => link(type, axis, axes, { parent: i, mass: 2 - 0.2 * i, ...more }))],
});
const floating = { fixed: false, gravity: [0, 0, 0], rootVelocity: { linear: [0.3, 0.1, -0.2], angular: [0.5, -0.7, 1.1] } };
const ball = (actor0, actor1) => ({ motion: { twist: "free", swing1: "free", swing2: "free" }, actor0, actor1 });
const fourBar = [
  base(),
  link("revolute", "z", { x: free }),
  link("revolute", "z", { x: free }, { parent: 1, own: [0, 0.3, 0] }),
  link("revolute", "z", { x: free }, { parent: 2, at: [0, -0.3, 0.02], own: [0.3, 0, 0] }),
];

const fiveBar = (first) => [
  link("revolute", "z", { x: free }, { parent: first }),
  link("revolute", "z", { x: drive({ damping: 0.5 }) }, { parent: first + 1, at: [0.3, 0.05, 0], own: [0, 0.3, 0] }),
  link("revolute", "z", { x: free }, { parent: first, at: [0.3, -0.52, 0.02], own: [-0.3, 0, -0.03] }),
];
const closed = (first) => [{ ...ball({ link: first + 2 }, { link: first + 3 }), frame0: { position: [0, -0.3, 0] }, frame1: { position: [0.3, 0, 0] } }];

// Links of 0.6 m in one line along X, bent by an angle at the first joint and back at the second.
const stretched = (count, bent = 0) => ({
  links: [base(), ...Array.from({ length: count }, (_, i) => link("revolute", "z", { x: drive({ position: [bent, -2 * bent][i] ?? 0 }) }, { parent: i, at: [0.3, 0, 0], own: [-0.3, 0, 0] }))],
  joints: [{ ...ball(undefined, { link: count }), frame0: { position: [0.3 + 0.6 * count, 0, 0] }, frame1: { position: [0.3, 0, 0] } }],
});

const all = {
  "fixed-hangs": ["A link fixed to a fixed root stands still", arm("fixed", "z", {})],
  "revolute-free": ["A pendulum about Z", arm("revolute", "z", { x: free })],
  "revolute-tilted": ["A tilted axis and an anchor that is turned against the link", arm("revolute", "tilted", { x: free }, { turned: [0.1, -0.3, 0.5, 0.8] })],
  "revolute-start": ["Starts turned and in motion", arm("revolute", "z", { x: drive({ position: 0.7, speed: -3 }) })],
  "revolute-over-the-top": ["Fast enough for whole turns", arm("revolute", "z", { x: drive({ speed: 9 }) }, {})],
  "prismatic-free": ["Slides along a slanted axis", arm("prismatic", "tilted", { x: free })],
  "prismatic-start": ["Starts out and in motion", arm("prismatic", "y", { x: drive({ position: 0.2, speed: 3 }) })],
  "spherical-free": ["A ball, all three axes free", arm("spherical", "x", { x: free, y: free, z: free })],
  "spherical-spin": ["A ball that spins", arm("spherical", "x", { x: drive({ speed: 4 }), y: drive({ speed: -2 }), z: free })],
  "spherical-two": ["A ball with one axis locked", arm("spherical", "x", { y: free, z: free })],
  "spherical-one": ["A ball with two axes locked", arm("spherical", "x", { z: free })],
  "revolute-limits-lower": ["Falls onto the lower limit", arm("revolute", "z", { x: limited(-0.5, 0.6) })],
  "revolute-limits-upper": ["Thrown against the upper limit", arm("revolute", "z", { x: limited(-0.5, 0.6, { speed: 5 }) })],
  "revolute-limits-beyond": ["Starts beyond its limit", arm("revolute", "z", { x: limited(-0.3, 0.3, { position: 0.5 }) })],
  "prismatic-limits": ["Falls onto the lower end", arm("prismatic", "y", { x: limited(-0.2, 0.1) })],
  "prismatic-limits-upper": ["Thrown against the upper end", arm("prismatic", "y", { x: limited(-0.2, 0.1, { speed: 3 }) })],
  "spherical-limits": ["All axes limited", arm("spherical", "x", { x: limited(-0.3, 0.4, { speed: 3 }), y: limited(-0.5, 0.5), z: limited(-0.4, 0.2) })],
  "spherical-limit-one": ["One axis limited, the others damped", arm("spherical", "x", { x: drive({ damping: 1 }), y: drive({ damping: 1 }), z: limited(-0.4, 0.2) })],
  "drive-force": ["Spring and damper to a target", arm("revolute", "z", { x: drive({ stiffness: 60, damping: 6, target: 0.8 }) })],
  "drive-force-stiff": ["A stiff one", arm("revolute", "z", { x: drive({ stiffness: 1e5, damping: 1e3, target: 0.8 }) })],
  "drive-acceleration": ["The same by acceleration", arm("revolute", "z", { x: drive({ stiffness: 100, damping: 12, target: -0.8, acceleration: true }) })],
  "drive-velocity": ["Damper to a speed", arm("revolute", "z", { x: drive({ damping: 40, targetSpeed: 2 }) })],
  "drive-velocity-acceleration": ["Damper to a speed by acceleration", arm("revolute", "z", { x: drive({ damping: 40, targetSpeed: -2, acceleration: true }) })],
  "drive-target-type": ["Unity's type Target: no spring could be stiffer", arm("revolute", "z", { x: drive({ stiffness: 1e25, target: 0.3 }) })],
  "drive-velocity-type": ["Unity's type Velocity: no damper could be stiffer", arm("revolute", "z", { x: drive({ damping: 1e25, targetSpeed: 1.5 }) })],
  "drive-clamped": ["Less torque than the weight asks for", arm("revolute", "z", { x: drive({ stiffness: 1e4, damping: 100, forceLimit: 3, target: 1 }) })],
  "drive-target-and-speed": ["Target, speed and damping together", arm("revolute", "z", { x: drive({ stiffness: 50, damping: 10, target: 0.5, targetSpeed: 1 }) })],
  "drive-limited": ["A drive that pulls beyond the limit", arm("revolute", "z", { x: limited(-0.5, 0.5, { stiffness: 500, damping: 20, target: 2 }) })],
  "drive-prismatic": ["A slide with a spring", arm("prismatic", "y", { x: drive({ stiffness: 200, damping: 10, target: 0.1 }) })],
  "drive-prismatic-acceleration": ["A slide by acceleration", arm("prismatic", "y", { x: drive({ stiffness: 80, damping: 10, target: -0.1, acceleration: true }) })],
  "drive-prismatic-velocity": ["A slide at a speed: 5.6.1's sense; 4.1 negates it (UnityArticulations.SlideSpeedSign)", arm("prismatic", "y", { x: drive({ damping: 500, targetSpeed: 0.1 }) })],
  "drive-prismatic-clamped": ["A slide too weak for its load", arm("prismatic", "y", { x: drive({ stiffness: 5000, damping: 50, forceLimit: 10, target: 0.2 }) })],
  "drive-spherical": ["A ball driven about one axis", arm("spherical", "x", { x: drive({ stiffness: 60, damping: 6, target: 0.6 }), y: free, z: free })],
  "drive-spherical-three": ["A ball driven about three axes: 5.6.1's gap, twice the vector part of the rotation left; 4.1 takes each axis by itself", arm("spherical", "x", { x: drive({ stiffness: 80, damping: 8, target: 0.4 }), y: drive({ stiffness: 80, damping: 8, target: -0.3 }), z: drive({ stiffness: 80, damping: 8, target: 0.5 }) })],
  "drive-spherical-acceleration": ["The same by acceleration", arm("spherical", "x", { x: drive({ stiffness: 90, damping: 14, target: 0.4, acceleration: true }), y: drive({ stiffness: 90, damping: 14, acceleration: true }), z: drive({ stiffness: 90, damping: 14, target: 0.5, acceleration: true }) })],
  "friction-rests": ["Friction that holds the link", arm("revolute", "z", { x: free }, { friction: 0.5 })],
  "friction-slips": ["Friction that does not", arm("revolute", "z", { x: free }, { friction: 0.05 })],
  "friction-prismatic": ["A slide with friction", arm("prismatic", "tilted", { x: drive({ speed: 1 }) }, { friction: 0.3 })],
  "friction-drive": ["Friction against a drive", arm("revolute", "z", { x: drive({ stiffness: 60, damping: 6, target: 0.8 }) }, { friction: 0.1 })],
  "friction-spherical": ["A ball with friction", arm("spherical", "x", { x: drive({ speed: 3 }), y: free, z: free }, { friction: 0.02 })],
  "damping-linear": ["Linear damping", arm("revolute", "z", { x: free }, { linearDamping: 2 })],
  "damping-angular": ["Angular damping", arm("revolute", "z", { x: free }, { angularDamping: 3 })],
  "damping-both": ["Both, stronger than a step can take", arm("spherical", "x", { x: drive({ speed: 3 }), y: free, z: free }, { linearDamping: 1, angularDamping: 80 })],
  "no-gravity": ["A link that gravity leaves alone", arm("revolute", "z", { x: drive({ speed: 1 }) }, { useGravity: false })],
  "max-speed": ["Falls no faster than the joint may", arm("revolute", "z", { x: free }, { maxSpeed: 2 })],
  "max-speed-drive": ["A drive faster than the joint may", arm("revolute", "z", { x: drive({ damping: 100, targetSpeed: 9 }) }, { maxSpeed: 4 })],
  "max-speed-prismatic": ["A slide falls no faster than it may", arm("prismatic", "y", { x: free }, { maxSpeed: 1.5 })],
  "iterations-one": ["One position iteration", arm("revolute", "z", { x: limited(-0.4, 1, { stiffness: 60, damping: 6, target: 0.8 }) }, {}, { iterations: [1, 1] })],
  "iterations-many": ["Sixteen", arm("revolute", "z", { x: drive({ stiffness: 60, damping: 6, target: 0.8 }) }, {}, { iterations: [16, 4] })],
  "iterations-no-velocity": ["No velocity iteration asked for", arm("revolute", "z", { x: limited(-0.4, 1) }, {}, { iterations: [4, 0] })],
  "compliance-none": ["Limits without PhysX 5's compliance", { links: [base({ compliance: 0 }), { ...link("revolute", "z", { x: limited(-0.5, 0.6) }), compliance: 0 }] }],
  "chain-double-pendulum": ["A double pendulum", chain([["revolute", "z", { x: free }], ["revolute", "z", { x: free }]])],
  "chain-crossed": ["Two axes that cross", chain([["revolute", "z", { x: free }], ["revolute", "y", { x: drive({ speed: 2 }) }]])],
  "chain-slide-on-turn": ["A slide on a turning link: the drive sees the centripetal part as PhysX does", chain([["revolute", "y", { x: drive({ speed: 4 }) }], ["prismatic", "x", { x: drive({ stiffness: 300, damping: 20 }) }]])],
  "chain-turn-on-slide": ["A pendulum on a slide", chain([["prismatic", "x", { x: free }], ["revolute", "z", { x: free }]])],
  "chain-driven-six": ["Six driven joints", chain(["y", "z", "z", "x", "z", "x"].map((axis, i) => ["revolute", axis, { x: drive({ stiffness: 900, damping: 90, target: 0.3 - 0.1 * i }) }]))],
  "chain-seven-limited": ["Seven joints fall onto their limits", chain(["y", "z", "x", "z", "y", "z", "x"].map((axis) => ["revolute", axis, { x: limited(-0.3, 0.3, { damping: 20 }) }]))],
  "chain-fixed-between": ["A fixed link between two turning ones", chain([["revolute", "z", { x: free }], ["fixed", "tilted", {}], ["revolute", "z", { x: drive({ damping: 0.5 }) }]])],
  "chain-spherical": ["Two balls", chain([["spherical", "x", { x: free, y: free, z: free }], ["spherical", "x", { x: free, y: free, z: free }]])],
  "tree-two-arms": ["Two arms on one root, driven", { links: [base(), link("revolute", "z", { x: drive({ stiffness: 90, damping: 9, target: 0.5 }) }), link("revolute", "y", { x: drive({ damping: 2, targetSpeed: 1 }) }, { at: [-0.3, 0, 0] }), link("revolute", "z", { x: drive({ stiffness: 50, damping: 5, target: -0.4 }) }, { parent: 1 })] }],
  "tree-branches": ["A link that carries two more", { links: [base(), link("revolute", "z", { x: drive({ stiffness: 200, damping: 20 }) }), link("revolute", "x", { x: drive({ damping: 1 }) }, { parent: 1 }), link("prismatic", "y", { x: limited(-0.1, 0.1, { stiffness: 80, damping: 4 }) }, { parent: 1, at: [0.1, 0.2, 0] })] }],
  "floating-falls": ["A floating root with a driven arm falls", { ...arm("revolute", "z", { x: drive({ stiffness: 60, damping: 6, target: 0.8 }) }), fixed: false }],
  "floating-tumbles": ["A floating pair tumbles without gravity: 5.6.1 gives back the momentum that a step takes, 4.1 does not", { ...floating, ...arm("revolute", "z", { x: drive({ speed: 2 }) }) }],
  "floating-slide": ["A floating slide", { ...floating, ...arm("prismatic", "tilted", { x: drive({ stiffness: 80, damping: 1, speed: 0.5 }) }) }],
  "floating-ball": ["A floating ball joint", { ...floating, ...arm("spherical", "x", { x: drive({ damping: 0.1 }), y: drive({ damping: 0.1 }), z: drive({ damping: 0.1 }) }) }],
  "floating-chain": ["A floating chain with limits", { ...floating, ...chain([["revolute", "z", { x: limited(-0.4, 0.4, { speed: 2 }) }], ["revolute", "y", { x: limited(-0.4, 0.4, { speed: -1 }) }], ["revolute", "x", { x: free }]]) }],
  "floating-single": ["A floating root alone", { ...floating, links: [base()] }],
  "force-on-link": ["Force and torque on a link", { ...arm("revolute", "z", { x: drive({ damping: 1 }) }), forces: [{ link: 1, force: [3, 25, 0], torque: [0, 0, 1] }] }],
  "force-on-root": ["A push on a floating root, for ten steps", { ...arm("revolute", "z", { x: drive({ damping: 0.2 }) }), fixed: false, gravity: [0, 0, 0], forces: [{ link: 0, force: [5, 2, 1], torque: [0, 0.2, 0.3], until: 10 }] }],
  "mass-ratio": ["A light link below a heavy one", chain([["revolute", "z", { x: drive({ stiffness: 2000, damping: 200 }) }], ["revolute", "z", { x: drive({ stiffness: 20, damping: 2, target: 0.4 }) }, { mass: 0.05, inertia: [0.001, 0.002, 0.002] }]])],
  "step-small": ["Steps of 5 ms", arm("revolute", "z", { x: limited(-0.6, 1, { damping: 0.5 }) }, {}, { dt: 0.005 })],
  "loop-to-world": ["A four-bar: a ball joint holds the tip of three links to the world", { links: fourBar, joints: [{ ...ball(undefined, { link: 3 }), frame0: { position: [0.3, -0.52, 0.09] }, frame1: { position: [-0.3, 0, 0] } }] }],
  "loop-to-world-driven": ["The same with a driven crank", { links: [fourBar[0], link("revolute", "z", { x: drive({ stiffness: 200, damping: 40, target: 0.6 }) }), ...fourBar.slice(2)], joints: [{ ...ball(undefined, { link: 3 }), frame0: { position: [0.3, -0.52, 0.09] }, frame1: { position: [-0.3, 0, 0] } }] }],
  "loop-of-links": ["A five-bar: a ball joint between the tips of two arms of an articulation closes the loop", { links: [base(), ...fiveBar(0)], joints: closed(0) }],
  "loop-on-a-link": ["The same on a link that swings: its ball joint takes no notice of what one tip's impulse does to the other", { links: [base(), link("revolute", "z", { x: free }, { at: [0, 0, 0], own: [0, 0.1, 0] }), ...fiveBar(1)], joints: closed(1) }],
  "loop-floating": ["The same on a floating root", { ...floating, links: [base(), ...fiveBar(0)], joints: closed(0) }],
  "loop-stretched": ["A ball joint holds the tip of two links in one line: its row along them has next to no response", stretched(2)],
  "loop-stretched-three": ["The same with three links", stretched(3)],
  "loop-near-stretched": ["Two links that are bent a little", stretched(2, 0.05)],
  "loop-with-body": ["A rigid body hangs on the tip by a ball joint", { ...arm("revolute", "z", { x: drive({ stiffness: 200, damping: 20 }) }), bodies: [{ position: [1.2, 0.03, 0.05], mass: 1, inertia: [0.02, 0.05, 0.04] }], joints: [{ ...ball({ link: 1 }, { body: 0 }), frame0: { position: [0.3, 0, 0] }, frame1: { position: [-0.3, 0, 0] } }] }],
};

export const scenarios = Object.entries(all).map(([name, [about, scenario]]) => ({ name, about, ...scenario }));
