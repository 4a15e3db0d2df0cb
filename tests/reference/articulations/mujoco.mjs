// Accelerations that MuJoCo 3.14 gives random trees of hinges and slides, root fixed: writes mujoco.json. No part of the tests' own packages:
// npm install --no-save @mujoco/mujoco@3.14.0 && node articulations/mujoco.mjs
import fs from "node:fs";
import loadMujoco from "@mujoco/mujoco";

const TREES = 24;

let state = 39;
const next = () => {
  state = (state + 0x6d2b79f5) | 0;
  let t = Math.imul(state ^ (state >>> 15), 1 | state);
  t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
  return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
};
const from = (low, high) => Math.round((low + (high - low) * next()) * 1000) / 1000;
const vector = (size) => [from(-size, size), from(-size, size), from(-size, size)];
const unit = (v) => v.map((x) => x / Math.hypot(...v));

// q * v for a quaternion x y z w.
const rotate = ([x, y, z, w], v) => {
  const t = cross([x, y, z], v).map((a) => 2 * a);
  const u = cross([x, y, z], t);
  return v.map((a, i) => a + w * t[i] + u[i]);
};
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const multiply = ([ax, ay, az, aw], [bx, by, bz, bw]) => [
  aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz,
];
const conjugate = ([x, y, z, w]) => [-x, -y, -z, w];

function tree() {
  const count = 2 + Math.floor(from(0, 9));
  return Array.from({ length: count }, (_, i) => {
    const mass = from(0.3, 4);
    const [a, b, c] = [from(0.1, 0.6), from(0.1, 0.6), from(0.1, 0.6)];
    const inertia = [b * b + c * c, a * a + c * c, a * a + b * b].map((x) => (x * mass) / 12);
    if (i === 0) {
      return { mass, inertia };
    }
    return {
      parent: Math.max(0, i - 1 - Math.floor(from(0, 2))), mass, inertia, type: next() < 0.7 ? "revolute" : "prismatic",
      parentFrame: { position: vector(0.4), rotation: unit([...vector(1), 0.5]) }, childFrame: { position: vector(0.4), rotation: unit([...vector(1), 0.5]) },
      position: from(-1, 1), speed: from(-3, 3), force: from(-5, 5),
    };
  });
}

function xml(links) {
  const body = (i) => {
    const l = links[i];
    const below = links.map((other, k) => (other.parent === i ? body(k) : "")).join("");
    const inertial = `<inertial pos="0 0 0" mass="${l.mass}" diaginertia="${l.inertia.join(" ")}"/>`;
    if (i === 0) {
      return `<body name="b0">${inertial}${below}</body>`;
    }
    const q = multiply(l.parentFrame.rotation, conjugate(l.childFrame.rotation));
    const shift = rotate(q, l.childFrame.position);
    const p = l.parentFrame.position.map((x, k) => x - shift[k]);
    const axis = rotate(l.childFrame.rotation, [1, 0, 0]);
    const joint = `<joint name="j${i}" type="${l.type === "revolute" ? "hinge" : "slide"}" pos="${l.childFrame.position.join(" ")}" axis="${axis.join(" ")}"/>`;
    return `<body name="b${i}" pos="${p.join(" ")}" quat="${q[3]} ${q[0]} ${q[1]} ${q[2]}">${joint}${inertial}${below}</body>`;
  };
  return `<mujoco><compiler angle="radian" balanceinertia="false"/><option gravity="0.3 -9.81 0.2"/><worldbody>${body(0)}</worldbody></mujoco>`;
}

const mujoco = await loadMujoco();
const out = [];
for (let n = 0; n < TREES; n++) {
  const links = tree();
  const model = mujoco.MjModel.from_xml_string ? mujoco.MjModel.from_xml_string(xml(links)) : mujoco.MjModel.loadFromXML(xml(links));
  const data = new mujoco.MjData(model);
  // MuJoCo numbers joints depth first.
  const order = [];
  const visit = (i) => links.forEach((l, k) => l.parent === i && (order.push(k), visit(k)));
  visit(0);
  order.forEach((k, j) => {
    data.qpos[j] = links[k].position;
    data.qvel[j] = links[k].speed;
    data.qfrc_applied[j] = links[k].force;
  });
  mujoco.mj_forward(model, data);
  order.forEach((k, j) => (links[k].acceleration = Number(data.qacc[j].toPrecision(15))));
  out.push(links);
  data.delete?.();
  model.delete?.();
}
fs.writeFileSync(new URL("mujoco.json", import.meta.url), `[\n${out.map((links) => JSON.stringify(links)).join(",\n")}\n]\n`);
console.log(`${out.length} trees`);
