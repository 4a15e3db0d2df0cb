// Random articulations and where PhysX 5.6.1 has each after its first step; later ones hang on float's rounding where a limit is met: node articulations/fuzz.mjs COUNT SEED writes out/articulations.json.
import fs from "node:fs";
import { loadPhysX5 } from "./physx5.mjs";
import { run } from "./run.mjs";

const [count = 2000, seed = 1] = process.argv.slice(2).map(Number);
const TYPES = ["fixed", "prismatic", "revolute", "revolute", "spherical"];

let state = seed >>> 0;
const next = () => {
  state = (state + 0x6d2b79f5) | 0;
  let t = Math.imul(state ^ (state >>> 15), 1 | state);
  t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
  return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
};
const from = (low, high) => low + (high - low) * next();
const chance = (share) => next() < share;
const pick = (...values) => values[Math.floor(next() * values.length)];
const vector = (size) => [from(-size, size), from(-size, size), from(-size, size)];
const rotation = () => {
  const q = [...vector(1), from(-1, 1)];
  return q.map((x) => x / Math.hypot(...q));
};

function axis(type) {
  const a = { motion: chance(0.35) ? "limited" : "free", position: type === "spherical" ? from(-0.4, 0.4) : from(-0.8, 0.8), speed: from(-2, 2) };
  if (a.motion === "limited") {
    Object.assign(a, { lower: from(-0.9, -0.1), upper: from(0.1, 0.9) });
  }
  if (chance(0.5)) {
    Object.assign(a, { stiffness: pick(0, 10, 300), damping: pick(1, 30), target: from(-0.5, 0.5), targetSpeed: pick(0, from(-1, 1)), acceleration: chance(0.3) });
    if (chance(0.3)) {
      a.forceLimit = from(0.5, 20);
    }
  }
  return a;
}

function link(index) {
  const [a, b, c] = [from(0.05, 0.6), from(0.05, 0.6), from(0.05, 0.6)];
  const mass = from(0.3, 4);
  const body = { mass, inertia: [b * b + c * c, a * a + c * c, a * a + b * b].map((x) => (x * mass) / 12 + 0.01), linearDamping: pick(0, 0, from(0, 2)), angularDamping: pick(0, 0.05, from(0, 3)), useGravity: chance(0.9) };
  if (index === 0) {
    return body;
  }
  const type = pick(...TYPES);
  // A drive of a ball takes its target in the axes of the child's body (ArticulationRules.DrivesSphericalByRotation): alike for an unturned anchor.
  const childFrame = type === "spherical" ? { position: vector(0.4) } : { position: vector(0.4), rotation: rotation() };
  const axes = type === "fixed" ? {} : type === "spherical" ? { x: axis(type), y: axis(type), z: axis(type) } : { x: axis(type) };
  const parent = Math.max(0, index - 1 - Math.floor(from(0, 3)));
  return { ...body, parent, joint: { type, parentFrame: { position: vector(0.4), rotation: rotation() }, childFrame, axes, friction: pick(0, 0, from(0, 0.2)), maxSpeed: pick(1e6, 1e6, from(0.5, 3)) } };
}

function tree(number) {
  const links = Array.from({ length: 1 + Math.floor(from(1, 12)) }, (_, i) => link(i));
  const fixed = chance(0.5);
  return {
    name: `tree-${number}`, about: "", fixed, steps: 1, sample: 1, iterations: pick([6, 1], [4, 1], [1, 1], [10, 2]), links,
    ...(fixed ? {} : { rootVelocity: { linear: vector(1), angular: vector(1) } }),
  };
}

// PhysX gets floats: both sides shall read the same numbers.
const asFloats = (o) => JSON.parse(JSON.stringify(o, (_, v) => (typeof v === "number" ? Math.fround(v) : v)));

const world = await loadPhysX5();
const lines = Array.from({ length: count }, (_, i) => {
  const scenario = asFloats(tree(i));
  return JSON.stringify({ ...scenario, trace: run(world, scenario) });
});
fs.mkdirSync(new URL("../out", import.meta.url), { recursive: true });
fs.writeFileSync(new URL("../out/articulations.json", import.meta.url), `[\n${lines.join(",\n")}\n]\n`);
console.log(`${lines.length} trees`);
