// Random scenarios and PhysX's states after every step of them: node fuzz.mjs COUNT SEED writes out/fuzz.json.
// Left out, since there PhysX's rounding decides: frozen moments of inertia, projection tolerances near a float's
// resolution of a cosine, contact distances wider than a cone.
import fs from "node:fs";
import { loadPhysX } from "./physx.mjs";
import { run } from "./scenario.mjs";

const ORIGIN = { position: [0, 0, 0], rotation: [0, 0, 0, 1] };
const LOCKS = ["linearX", "linearY", "linearZ", "angularX", "angularY", "angularZ"];

function random(seed) {
  let a = seed >>> 0;
  const next = () => {
    a = (a + 0x6d2b79f5) | 0;
    let t = Math.imul(a ^ (a >>> 15), 1 | a);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
  const from = (low, high) => low + (high - low) * next();
  const vector = (size) => [from(-size, size), from(-size, size), from(-size, size)];
  return {
    from,
    vector,
    integer: (low, high) => Math.floor(from(low, high + 1)),
    scale: (low, high) => Math.exp(from(Math.log(low), Math.log(high))),
    chance: (share) => next() < share,
    pick: (...values) => values[Math.floor(next() * values.length)],
    rotation: () => unit([...vector(1), from(-1, 1)]),
  };
}

const unit = (q) => q.map((x) => x / Math.hypot(...q));
const conjugate = ([x, y, z, w]) => [-x, -y, -z, w];
const turn = (axis, angle) => [...unit(axis).map((x) => x * Math.sin(angle / 2)), Math.cos(angle / 2)];
const multiply = ([ax, ay, az, aw], [bx, by, bz, bw]) => [
  aw * bx + ax * bw + ay * bz - az * by,
  aw * by - ax * bz + ay * bw + az * bx,
  aw * bz + ax * by - ay * bx + az * bw,
  aw * bw - ax * bx - ay * by - az * bz,
];
const rotate = (q, v) => multiply(multiply(q, [...v, 0]), conjugate(q)).slice(0, 3);
const compose = (a, b) => ({
  position: rotate(a.rotation, b.position).map((x, i) => x + a.position[i]),
  rotation: unit(multiply(a.rotation, b.rotation)),
});
const inverse = (a) => ({ position: rotate(conjugate(a.rotation), a.position.map((x) => -x)), rotation: conjugate(a.rotation) });

// PhysX gets floats: both sides shall read the same numbers.
const asFloats = (o) => JSON.parse(JSON.stringify(o, (_, v) => (typeof v === "number" ? Math.fround(v) : v)));

function makeScenario(seed) {
  const r = random(seed);
  const count = r.pick(1, 1, 2, 2, r.integer(3, 6), r.integer(7, 20));
  const bodies = Array.from({ length: count }, () => makeBody(r));
  if (count > 1 && r.chance(0.2)) {
    const moved = r.pick(...bodies);
    delete moved.locks;
    Object.assign(moved, { kinematic: true, linearVelocity: r.vector(0.5), angularVelocity: r.vector(1) });
  }
  // A chain with or without the world, and more joints anywhere.
  const pairs = bodies.map((_, i) => [i - 1, i]).filter(([a]) => a >= 0 || count === 1 || r.chance(0.7));
  for (let i = r.integer(0, count); i > 0; i--) {
    const [a, b] = [r.integer(-1, count - 1), r.integer(0, count - 1)];
    pairs.splice(r.integer(0, pairs.length), 0, ...(a === b ? [] : [[a, b]]));
  }
  return asFloats({
    name: `fuzz-${seed}`,
    about: "",
    dt: r.pick(0.02, 0.02, 0.02, 0.005, 1 / 60, 0.05),
    steps: count > 6 ? 20 : 60,
    sample: 1,
    bodies,
    joints: pairs.map(([a, b]) => makeJoint(r, bodies, ...(r.chance(0.5) ? [a, b] : [b, a]))),
  });
}

function makeBody(r) {
  const mass = r.scale(0.2, 8);
  const moment = mass * r.scale(0.02, 0.3);
  return {
    position: r.vector(1),
    rotation: r.rotation(),
    mass,
    inertia: [1, 2, 3].map(() => moment * r.from(0.5, 2)),
    linearVelocity: r.vector(2),
    angularVelocity: r.vector(r.pick(4, 4, 30)),
    ...(r.chance(0.2) && { linearDamping: r.scale(0.05, 5), angularDamping: r.scale(0.05, 5) }),
    ...(r.chance(0.2) && { iterations: [r.pick(1, 2, 10, 20), r.pick(1, 2, 4)] }),
    ...(r.chance(0.1) && { useGravity: false }),
    ...(r.chance(0.1) && { locks: LOCKS.filter(() => r.chance(0.3)) }),
  };
}

function makeJoint(r, bodies, body0, body1) {
  const pose = (i) => bodies[i] ?? ORIGIN;
  const type = r.pick("revolute", "d6", "d6");
  const { fields, way, axis } = type === "d6" ? makeD6(r) : makeRevolute(r);
  const frame0 = compose({ ...ORIGIN, position: pose(body0 < 0 ? body1 : body0).position }, { position: r.vector(0.6), rotation: r.rotation() });
  let frame1 = compose(frame0, { position: way, rotation: turn(axis, r.from(0, 1)) });
  if (r.chance(0.1)) {
    frame1 = compose(frame1, { position: r.vector(0.05), rotation: turn(r.vector(1), r.from(0, 0.15)) });
  }
  const breaks = r.chance(0.1);
  return {
    type,
    ...(body0 >= 0 && { body0 }),
    ...(body1 >= 0 && { body1 }),
    frame0: compose(inverse(pose(body0)), frame0),
    frame1: compose(inverse(pose(body1)), frame1),
    ...fields,
    ...(r.chance(0.1) && { preprocessing: false }),
    ...(r.chance(0.1) && { inverseMassScales: [1, 2, 3, 4].map(() => r.scale(0.2, 5)) }),
    ...(r.chance(0.1) && { driveLimitsAreForces: false }),
    ...(r.chance(0.1) && { extendedLimits: true }),
    ...(breaks && { breakForce: r.scale(5, 500), breakTorque: r.scale(1, 200) }),
    // After a break PhysX plants its trees in an order of its own memory.
    ...(!breaks && bodies.length < 3 && r.chance(0.2) && { projection: { linear: r.scale(1e-3, 0.1), angular: r.scale(0.05, 1) } }),
  };
}

function makeRevolute(r) {
  const fields = {
    ...(r.chance(0.5) && { limit: { ...angles(r), ...response(r) } }),
    ...(r.chance(0.4) && { motor: { velocity: r.from(-6, 6), forceLimit: r.scale(0.2, 50), freeSpin: r.chance(0.4) } }),
  };
  return { fields, way: [0, 0, 0], axis: [1, 0, 0] };
}

function makeD6(r) {
  const motion = Object.fromEntries(["x", "y", "z", "twist", "swing1", "swing2"].map((a) => [a, r.pick("locked", "limited", "free")]));
  const free = ["x", "y", "z", "twist", "swing1", "swing2"].map((a) => (motion[a] === "locked" ? 0 : 1));
  const [y, z] = [r.from(0.2, 1.5), r.from(0.2, 1.5)];
  const drives = ["x", "y", "z", "twist", "swing", "slerp"].filter(() => r.chance(0.2));
  const fields = {
    motion,
    linearLimit: { value: r.scale(0.02, 1), ...response(r) },
    twistLimit: { ...angles(r), ...response(r) },
    swingLimit: { y, z, ...response(r, 0.4 * Math.min(y, z)) },
    drives: Object.fromEntries(drives.map((d) => [d, drive(r)])),
    drivePose: { position: r.vector(0.4), rotation: turn(r.vector(1), r.from(0, 2.5)) },
    driveVelocity: { linear: r.vector(2), angular: r.vector(4) },
  };
  return { fields, way: free.slice(0, 3).map((f) => f * r.from(-0.3, 0.3)), axis: free.slice(3).map((f) => f * r.from(-1, 1) + 1e-9) };
}

function angles(r) {
  const [a, b] = r.pick([r.from(-1.2, 1.2), r.from(-1.2, 1.2)], [-r.from(0.1, 3.1), r.from(0.1, 3.1)], [-r.from(1, 2), -r.from(0.2, 0.9)]);
  return { lower: Math.min(a, b), upper: Math.max(a, b) + 0.02 };
}

function response(r, widest = 0.5) {
  return r.chance(0.3)
    ? { stiffness: r.scale(5, 3000), damping: r.scale(0.1, 50) }
    : { contactDistance: Math.min(widest, r.pick(0.005, 0.05, 0.3)), restitution: r.pick(0, 0, 0.5, 1), bounceThreshold: r.pick(0, 0.5, 2) };
}

function drive(r) {
  return {
    stiffness: r.pick(0, r.scale(2, 3000)),
    damping: r.scale(0.1, 200),
    ...(r.chance(0.4) && { forceLimit: r.scale(0.3, 60) }),
    acceleration: r.chance(0.4),
  };
}

function record(physx, scenario) {
  const states = [];
  const { broken = [] } = run(physx, scenario, (bodies) =>
    bodies.forEach((b) => {
      const { translation: p, rotation: q } = b.getGlobalPose();
      const [v, w] = [b.getLinearVelocity(), b.getAngularVelocity()];
      states.push(p.x, p.y, p.z, q.x, q.y, q.z, q.w, v.x, v.y, v.z, w.x, w.y, w.z);
    }),
  );
  return { ...scenario, states, broken };
}

const [count = 300, seed = 1] = process.argv.slice(2).map(Number);
const physx = await loadPhysX();
const lines = Array.from({ length: count }, (_, i) => JSON.stringify(record(physx, makeScenario(seed * 100_000 + i))));
fs.mkdirSync(new URL("out/", import.meta.url), { recursive: true });
fs.writeFileSync(new URL("out/fuzz.json", import.meta.url), `[\n${lines.join(",\n")}\n]\n`);
