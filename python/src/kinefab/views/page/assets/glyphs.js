// Joints as glyphs: axes, arcs of the limits, rails with their ends; and overlays of couplings, colliders and traces.
/* global THREE, asMatrix, Frame */

const COLOURS = { HingeJoint: 0xe8590c, ConfigurableJoint: 0x1c7ed6, FixedJoint: 0x868e96 };
const ARC = 40;

function line(points, colour, dashed = false) {
  const geometry = new THREE.BufferGeometry().setFromPoints(points);
  const options = { color: colour, depthTest: false, transparent: true };
  const made = new THREE.Line(geometry, dashed
    ? new THREE.LineDashedMaterial({ ...options, dashSize: 0.1, gapSize: 0.07, scale: 1 }) : new THREE.LineBasicMaterial(options));
  if (dashed) made.computeLineDistances();
  made.renderOrder = 5;
  return made;
}

function solid(geometry, colour, opacity = 1) {
  const made = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({
    color: colour, depthTest: false, transparent: true, opacity, side: THREE.DoubleSide }));
  made.renderOrder = 6;
  return made;
}

// Along Y: a ball whose halves stand apart. The odd number of rings leaves none on its equator.
function capsule(radius, height) {
  const made = new THREE.SphereGeometry(radius, 16, 11), place = made.attributes.position;
  const apart = Math.max(0, height / 2 - radius);
  for (let i = 0; i < place.count; i++) place.setY(i, place.getY(i) + Math.sign(place.getY(i)) * apart);
  return made;
}

class Glyphs {
  constructor(stage, mechanism, data) {
    this.stage = stage;
    this.mechanism = mechanism;
    this.data = data;
    this.scale = 0.045 * stage.size;
    this.colliders = null;
    this.items = new Map(); // by the joint's number, each built when it is first shown
    this.ties = data.couplings.map((coupling) => this.tie(coupling));
    this.traces = [];
    this.bars();
  }
  // Bodies without a mesh, as bars between their joints.
  bars() {
    const drawn = new Set(this.data.parts.filter((part) => part.mesh !== null).map((part) => part.body));
    const points = new Map();
    for (const joint of this.data.joints) for (const [body, at] of [[joint.a, joint.at], [joint.b, joint.atB]])
      if (!drawn.has(body)) points.set(body, [...(points.get(body) || []), new THREE.Vector3(at[3], at[7], at[11])]);
    const palette = [0x8d99a8, 0x7fa7c9, 0xc9a67f, 0x8fbf9a, 0xb79ac4];
    for (const [body, ends] of points) {
      if (body === 0) continue;
      const middle = ends.length > 2 ? ends.reduce((sum, p) => sum.add(p), new THREE.Vector3()).divideScalar(ends.length) : null;
      const pairs = ends.length === 2 ? [[ends[0], ends[1]]] : middle ? ends.map((p) => [middle, p]) : [];
      const material = new THREE.MeshStandardMaterial({ color: palette[body % palette.length], roughness: 0.6 });
      for (const [from, to] of pairs) {
        const length = from.distanceTo(to);
        if (length < 1e-6 * this.stage.size) continue;
        const bar = new THREE.Mesh(new THREE.CylinderGeometry(0.16 * this.scale, 0.16 * this.scale, length, 18), material);
        bar.position.copy(from).add(to).multiplyScalar(0.5);
        bar.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), to.clone().sub(from).normalize());
        bar.castShadow = bar.receiveShadow = true;
        bar.userData.part = this.data.parts.findIndex((part) => part.body === body);
        this.stage.bodies[body].add(bar);
        this.stage.bars.push(bar);
      }
    }
  }
  build(index) {
    const joint = this.data.joints[index];
    const s = this.scale, colour = COLOURS[joint.type], base = new THREE.Group(), rider = new THREE.Group();
    const axis = (i, r) => new THREE.Vector3().setComponent(i, r);
    const dashed = joint.closure;
    for (const freedom of joint.freedoms) {
      const i = freedom.index % 3, across = (i + 1) % 3, third = (i + 2) % 3;
      if (freedom.index >= 3) {
        base.add(line([axis(i, -1.5 * s), axis(i, 1.5 * s)], colour, dashed));
        const free = freedom.lower === null, low = free ? 0 : freedom.lower, high = free ? 2 * Math.PI : freedom.upper;
        const point = (a) => new THREE.Vector3().setComponent(across, s * Math.cos(a)).setComponent(third, s * Math.sin(a));
        const arc = [];
        for (let k = 0; k <= ARC; k++) arc.push(point(low + ((high - low) * k) / ARC));
        base.add(line(arc, colour, dashed));
        if (!free) {
          const fan = new THREE.BufferGeometry(), corners = [];
          for (let k = 0; k < ARC; k++) for (const p of [new THREE.Vector3(), arc[k], arc[k + 1]]) corners.push(p.x, p.y, p.z);
          fan.setAttribute("position", new THREE.Float32BufferAttribute(corners, 3));
          base.add(solid(fan, colour, 0.16));
          for (const end of [arc[0], arc[ARC]]) base.add(line([new THREE.Vector3(), end.clone().multiplyScalar(1.15)], colour));
        }
        if (joint.freedoms.length < 3) rider.add(line([new THREE.Vector3(), point(0).multiplyScalar(1.12)], 0xffd43b));
      } else {
        const free = freedom.lower === null, low = free ? -2 * s : freedom.lower, high = free ? 2 * s : freedom.upper;
        for (const side of [-0.16, 0.16]) {
          const rail = [low, high].map((x) => axis(i, x).setComponent(across, side * s));
          base.add(line(rail, colour, dashed));
        }
        if (!free) for (const x of [low, high])
          base.add(line([axis(i, x).setComponent(across, -0.4 * s), axis(i, x).setComponent(across, 0.4 * s)], colour));
        const car = solid(new THREE.BoxGeometry(0.34 * s, 0.34 * s, 0.34 * s), 0xffd43b, 0.9);
        rider.add(car);
      }
    }
    if (!joint.freedoms.length) rider.add(solid(new THREE.BoxGeometry(0.5 * s, 0.5 * s, 0.5 * s), colour, 0.8));
    if (joint.freedoms.filter((f) => f.index >= 3).length === 3) rider.add(solid(new THREE.SphereGeometry(0.32 * s, 20, 14), colour, 0.7));
    const knob = solid(new THREE.SphereGeometry(0.17 * s, 16, 12), colour);
    knob.userData.joint = index;
    rider.add(knob);
    if (joint.closure) for (const group of [base, rider]) group.traverse((o) => { if (o.material) o.material.opacity *= 0.55; });
    [base, rider].forEach((group, side) => {
      group.matrixAutoUpdate = false;
      asMatrix(side ? joint.atB : joint.at, group.matrix);
    });
    return { joint, base, rider, knob };
  }
  tie(coupling) {
    const made = line(coupling.joints.slice(1).flatMap(() => [new THREE.Vector3(), new THREE.Vector3()]), 0x9c36b5);
    made.frustumCulled = false;
    this.stage.overlay.add(made);
    return { coupling, made };
  }
  // Which are shown: {joints, closures, couplings, colliders}.
  show(wanted) {
    this.wanted = wanted;
    this.data.joints.forEach((joint, i) => {
      const shown = wanted.joints && (!joint.closure || wanted.closures) || this.selected === joint;
      if (shown && !this.items.has(i)) this.items.set(i, this.build(i));
      const item = this.items.get(i);
      if (!item) return;
      const chosen = this.selected === joint;
      item.knob.scale.setScalar(chosen ? 2 : 1);
      item.knob.material.color.set(chosen ? 0x1f6feb : COLOURS[joint.type]);
      for (const [group, body] of [[item.base, joint.a], [item.rider, joint.b]])
        shown ? this.stage.bodies[body].add(group) : group.removeFromParent();
    });
    for (const { made } of this.ties) made.visible = wanted.couplings;
    if (wanted.colliders && !this.colliders) this.buildColliders();
    if (this.colliders) this.colliders.forEach((c) => (c.visible = wanted.colliders));
    this.follow();
  }
  select(joint) {
    this.selected = joint;
    if (this.wanted) this.show(this.wanted);
  }
  // Lines between coupled joints go where the joints are.
  follow() {
    for (const { coupling, made } of this.ties) {
      const ends = coupling.joints.map((i) => {
        const joint = this.data.joints[i];
        return Frame.point(this.mechanism.displaced[joint.b], [joint.atB[3], joint.atB[7], joint.atB[11]]);
      });
      const place = made.geometry.attributes.position;
      const driven = ends.pop();
      ends.flatMap((p) => [p, driven]).forEach((p, i) => place.setXYZ(i, ...p));
      place.needsUpdate = true;
    }
    this.stage.draw();
  }
  buildColliders() {
    const material = new THREE.MeshBasicMaterial({ color: 0x2f9e44, wireframe: true, transparent: true, opacity: 0.45 });
    this.colliders = [];
    for (const part of this.data.parts) for (const shape of part.colliders) {
      let geometry = null;
      if (shape.kind === "box") geometry = new THREE.BoxGeometry(...shape.size);
      if (shape.kind === "sphere") geometry = new THREE.SphereGeometry(shape.radius, 16, 10);
      if (shape.kind === "capsule") geometry = capsule(shape.radius, shape.height);
      if (shape.kind === "mesh") geometry = shaded(this.data.meshes[shape.mesh], this.data.array).geometry;
      if (!geometry) continue;
      const made = new THREE.Mesh(geometry, material);
      made.matrixAutoUpdate = false;
      made.matrix.copy(asMatrix(Frame.times(part.pose, shape.at)));
      this.stage.bodies[part.body].add(made);
      this.colliders.push(made);
    }
  }
  pick(x, y) {
    const knobs = [...this.items.values()].filter((item) => item.rider.parent).map((item) => item.knob);
    const hit = this.stage.ray(x, y).intersectObjects(knobs, false)[0];
    return hit ? hit.object.userData.joint : null;
  }
  // The path of a point of a body while the given freedoms go through their ranges.
  trace(body, point, names) {
    const mechanism = this.mechanism, before = {}, path = [], count = 181;
    for (const name of mechanism.freedoms) before[name] = mechanism.q[name];
    for (let k = 0; k < count; k++) {
      const goal = {};
      for (const name of names) {
        const [low, high] = mechanism.range[name];
        goal[name] = low + ((high - low) * k) / (count - 1);
      }
      mechanism.set(goal);
      path.push(new THREE.Vector3(...Frame.point(mechanism.displaced[body], point)));
    }
    mechanism.set(before);
    const made = line(path, 0xf03e3e);
    const dot = solid(new THREE.SphereGeometry(0.1 * this.scale, 12, 8), 0xf03e3e);
    dot.position.set(...point);
    this.stage.bodies[body].add(dot);
    this.stage.overlay.add(made);
    this.traces.push(made, dot);
    this.stage.draw();
    return path.map((p) => p.toArray());
  }
  clearTraces() {
    this.traces.forEach((made) => made.removeFromParent());
    this.traces = [];
    this.stage.draw();
  }
}
