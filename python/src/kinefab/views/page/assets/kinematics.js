// Where every body is at given joint coordinates.  Blocks are moved one after the other, roots first: a single joint in
// closed form, a loop of one freedom along its baked curve, any other by Newton's method on its own equations.
// Frames are rows of 3 x 4 (rotation, then place), right-handed, metres and radians.

const Frame = {
  identity: () => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0],
  times(a, b) {
    const c = new Array(12);
    for (let i = 0; i < 3; i++) {
      const x = a[4 * i], y = a[4 * i + 1], z = a[4 * i + 2];
      for (let j = 0; j < 4; j++) c[4 * i + j] = x * b[j] + y * b[4 + j] + z * b[8 + j];
      c[4 * i + 3] += a[4 * i + 3];
    }
    return c;
  },
  inverse(a) {
    const c = [a[0], a[4], a[8], 0, a[1], a[5], a[9], 0, a[2], a[6], a[10], 0];
    for (let i = 0; i < 3; i++) c[4 * i + 3] = -(c[4 * i] * a[3] + c[4 * i + 1] * a[7] + c[4 * i + 2] * a[11]);
    return c;
  },
  point: (a, p) => [0, 4, 8].map((i) => a[i] * p[0] + a[i + 1] * p[1] + a[i + 2] * p[2] + a[i + 3]),
  direction: (a, v) => [0, 4, 8].map((i) => a[i] * v[0] + a[i + 1] * v[1] + a[i + 2] * v[2]),
  turn(axis, angle) {
    const c = Math.cos(angle), s = Math.sin(angle), j = (axis + 1) % 3, k = (axis + 2) % 3, f = Frame.identity();
    f[5 * j] = c; f[5 * k] = c; f[4 * k + j] = s; f[4 * j + k] = -s;
    return f;
  },
  quaternion(q, p) {
    const [x, y, z, w] = q;
    return [
      1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), p[0],
      2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), p[1],
      2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), p[2],
    ];
  },
};

class JointBlock {
  constructor(block) {
    this.frame = block.frame.flat();
    this.start = block.start.flat();
    this.inverse = block.inverse;
    this.freedoms = block.freedoms;
    this.names = block.coordinates;
    this.held = block.held;
  }
  // Displacements of the block's bodies against its root; q: all coordinates by name, of which the held ones decide.
  move(q) {
    let shift = Frame.identity(), turn = Frame.identity();
    this.freedoms.forEach((freedom, i) => {
      const value = q[this.names[i]];
      if (freedom < 3) shift[4 * freedom + 3] = value;
      else turn = Frame.times(Frame.turn(freedom - 3, value), turn);
    });
    const moved = Frame.times(shift, turn);
    return [
      this.inverse
        ? Frame.times(this.start, Frame.inverse(Frame.times(this.frame, moved)))
        : Frame.times(Frame.times(this.frame, moved), Frame.inverse(this.start)),
    ];
  }
}

class CurveBlock {
  constructor(block, array) {
    Object.assign(this, block);
    this.names = block.coordinates;
    this.values = array(block.values);
    this.rotations = array(block.rotations);
    this.shifts = array(block.shifts);
    this.count = this.values.length / this.names.length;
    this.size = block.bodies.length;
  }
  move(q) {
    const span = this.high - this.low;
    let value = q[this.held[0]];
    if (this.whole) value = this.low + ((((value - this.low) % span) + span) % span);
    const share = Math.min(1, Math.max(0, (value - this.low) / span));
    const u = (this.even ? share : Math.acos(1 - 2 * share) / Math.PI) * (this.count - 1);
    const first = Math.min(Math.max(Math.floor(u) - 1, 0), this.count - 4), t = u - first;
    const weight = [
      (-(t - 1) * (t - 2) * (t - 3)) / 6, (t * (t - 2) * (t - 3)) / 2, (-t * (t - 1) * (t - 3)) / 2,
      (t * (t - 1) * (t - 2)) / 6,
    ];
    const blend = (data, width, at) => {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += weight[k] * data[(first + k) * width + at];
      return sum;
    };
    this.names.forEach((name, i) => {
      if (name !== this.held[0]) q[name] = blend(this.values, this.names.length, i);
    });
    const frames = [];
    for (let b = 0; b < this.size; b++) {
      const r = [0, 1, 2, 3].map((i) => blend(this.rotations, 4 * this.size, 4 * b + i)), length = Math.hypot(...r);
      frames.push(Frame.quaternion(r.map((x) => x / length), [0, 1, 2].map((i) => blend(this.shifts, 3 * this.size, 3 * b + i))));
    }
    return frames;
  }
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const NONE = [0, 0, 0];

// Residual and wrench (force, its point, free moment) of each kind of equation, as in analysis/equations/atoms.py.
const ATOMS = [
  (pa, a, k, pb, b, d) => [dot(a, minus(pb, pa)) - d, a, pb, NONE],
  (pa, a, k, pb, b, d) => [dot(a, b) - d, NONE, pb, cross(b, a)],
  (pa, a, k, pb, b, d) => {
    const across = cross(k, a), s = dot(across, b), c = dot(a, b), n = s * s + c * c;
    return [Math.atan2(s, c) - d, NONE, pb, scaled(minus(scaled(cross(b, across), c), scaled(cross(b, a), s)), 1 / n)];
  },
  (pa, a, k, pb, b, d) => {
    const away = minus(pb, pa), size = Math.hypot(...away);
    return [size - d, scaled(away, 1 / Math.max(size, 1e-30)), pb, NONE];
  },
  (pa, a, k, pb, b, d) => {
    const offset = minus(pb, pa), away = minus(offset, scaled(a, dot(a, offset))), size = Math.hypot(...away);
    return [size - d, scaled(away, 1 / Math.max(size, 1e-30)), pb, NONE];
  },
  (pa, a, k, pb, b, d) => {
    const normal = cross(a, b), size = Math.max(Math.hypot(...normal), 1e-15), n = scaled(normal, 1 / size);
    const offset = minus(pb, pa);
    return [dot(n, offset) - d, n, plus(pb, scaled(b, dot(cross(offset, a), normal) / (size * size))), NONE];
  },
  (pa, a, k, pb, b, d) => {
    const radius = Math.hypot(...k), n = scaled(a, Math.sign(d)), flat = minus(n, scaled(b, dot(b, n)));
    const span = Math.hypot(...flat), u = scaled(flat, 1 / Math.max(span, 1e-30));
    return [dot(n, minus(pb, pa)) - radius * span, n, minus(pb, scaled(u, radius)), NONE];
  },
  (pa, a, k, pb, b, d) => {
    const offset = minus(pb, pa);
    return [dot(a, cross(offset, b)) - d, cross(b, a), pb, cross(b, cross(a, offset))];
  },
];
const ANGLE = 2, TURN = 2 * Math.PI;

class Equations {
  constructor(system, center, length, array) {
    for (const name of ["kind", "row", "body_a", "body_b", "p_a", "a", "k", "p_b", "b", "d", "scale", "angle"])
      this[name] = Array.from(array(system[name]));
    this.rows = system.rows;
    this.center = center;
    this.length = length;
  }
  // Residual by row, and its rates by scaled twists, dense; state: rotation (9) and shift (3) of each body.
  linearise(state, angle, wanted = true) {
    const n = state.length, residual = new Float64Array(this.rows), rates = wanted ? [] : null;
    if (wanted) for (let i = 0; i < this.rows; i++) rates.push(new Float64Array(6 * n));
    const three = (values, i) => [values[3 * i], values[3 * i + 1], values[3 * i + 2]];
    for (let i = 0; i < this.kind.length; i++) {
      const bodies = [this.body_a[i], this.body_b[i]];
      const turned = (body, v) => (body ? Frame.direction(state[body - 1], v) : v);
      const placed = (body, p) => (body ? Frame.point(state[body - 1], p) : p);
      let [value, f, c, tau] = ATOMS[this.kind[i]](
        placed(bodies[0], three(this.p_a, i)), turned(bodies[0], three(this.a, i)), turned(bodies[0], three(this.k, i)),
        placed(bodies[1], three(this.p_b, i)), turned(bodies[1], three(this.b, i)), this.d[i]);
      if (this.kind[i] === ANGLE) {
        const last = angle[i] - this.d[i], away = value - last + Math.PI;
        value = last + away - TURN * Math.floor(away / TURN) - Math.PI;
      }
      residual[this.row[i]] += this.scale[i] * value;
      if (!wanted) continue;
      bodies.forEach((body, side) => {
        if (!body) return;
        const sign = this.scale[i] * (side ? 1 : -1), size = this.length[body - 1], row = rates[this.row[i]];
        const arm = minus(c, Frame.point(state[body - 1], this.center[body - 1])), moment = plus(cross(arm, f), tau);
        for (let j = 0; j < 3; j++) {
          row[6 * body - 6 + j] += sign * size * f[j];
          row[6 * body - 3 + j] += sign * moment[j];
        }
      });
    }
    return [residual, rates];
  }
  // The angles at a pose, counted on from the last ones.
  angles(state, angle) {
    const found = angle.slice();
    const three = (values, i) => [values[3 * i], values[3 * i + 1], values[3 * i + 2]];
    this.kind.forEach((kind, i) => {
      if (kind !== ANGLE) return;
      const turned = (body, v) => (body ? Frame.direction(state[body - 1], v) : v);
      const a = turned(this.body_a[i], three(this.a, i)), k = turned(this.body_a[i], three(this.k, i));
      const away = Math.atan2(dot(cross(k, a), turned(this.body_b[i], three(this.b, i))),
        dot(a, turned(this.body_b[i], three(this.b, i)))) - angle[i] + Math.PI;
      found[i] = angle[i] + away - TURN * Math.floor(away / TURN) - Math.PI;
    });
    return found;
  }
}

// The least change that mends the rows: x = J' (J J' + e)^-1 r.
function leastNorm(rates, residual) {
  const m = rates.length, n = rates[0].length, square = [];
  let largest = 0;
  for (let i = 0; i < m; i++) {
    square.push(new Float64Array(m));
    for (let j = 0; j <= i; j++) {
      let sum = 0;
      for (let k = 0; k < n; k++) sum += rates[i][k] * rates[j][k];
      square[i][j] = sum;
    }
    largest = Math.max(largest, square[i][i]);
  }
  const y = Float64Array.from(residual);
  for (let i = 0; i < m; i++) {
    square[i][i] += 1e-11 * largest;
    for (let j = 0; j <= i; j++) {
      let sum = square[i][j];
      for (let k = 0; k < j; k++) sum -= square[i][k] * square[j][k];
      square[i][j] = i === j ? Math.sqrt(Math.max(sum, 1e-14 * largest)) : sum / square[j][j];
    }
  }
  for (let i = 0; i < m; i++) {
    for (let k = 0; k < i; k++) y[i] -= square[i][k] * y[k];
    y[i] /= square[i][i];
  }
  for (let i = m - 1; i >= 0; i--) {
    for (let k = i + 1; k < m; k++) y[i] -= square[k][i] * y[k];
    y[i] /= square[i][i];
  }
  const x = new Float64Array(n);
  for (let i = 0; i < m; i++) for (let k = 0; k < n; k++) x[k] += rates[i][k] * y[i];
  return x;
}

class SolvedBlock {
  constructor(block, array) {
    const center = array(block.center), length = Array.from(array(block.length));
    const centers = length.map((_, i) => [center[3 * i], center[3 * i + 1], center[3 * i + 2]]);
    this.names = block.coordinates;
    this.held = block.held;
    this.own = new Equations(block.system, centers, length, array);
    this.probe = new Equations(block.probe, centers, length, array);
    this.at = this.held.map((name) => this.names.indexOf(name));
    this.state = length.map(() => Frame.identity());
    this.angle = [this.own.angle, this.probe.angle];
    this.now = this.read();
    this.length = length[0];
  }
  read() {
    return Array.from(this.probe.linearise(this.state, this.angle[1], false)[0]);
  }
  move(q) {
    const goal = this.held.map((name) => q[name]), start = this.at.map((i) => this.now[i]);
    const far = Math.max(...goal.map((value, i) => Math.abs(value - start[i]) / (this.rotary(i) ? 1 : this.length)), 0);
    const steps = Math.min(Math.ceil(far / 0.12), 400);
    for (let step = 1; step <= steps; step++) {
      const kept = [this.state.map((f) => f.slice()), this.angle.slice()];
      if (!this.solve(start.map((value, i) => value + ((goal[i] - value) * step) / steps))) {
        [this.state, this.angle] = kept;
        break;
      }
    }
    this.now = this.read();
    this.names.forEach((name, i) => (q[name] = this.now[i]));
    return this.state;
  }
  rotary(i) {
    return this.probe.kind[this.probe.row.indexOf(this.at[i])] === ANGLE;
  }
  solve(values) {
    for (let round = 0; round < 14; round++) {
      const [residual, rates] = this.own.linearise(this.state, this.angle[0]);
      const [read, readRates] = this.probe.linearise(this.state, this.angle[1]);
      const all = Array.from(residual), rows = rates.slice();
      this.at.forEach((at, i) => {
        const size = this.rotary(i) ? 1 : this.length;
        all.push((read[at] - values[i]) / size);
        rows.push(readRates[at].map((x) => x / size));
      });
      const worst = Math.max(...all.map(Math.abs), 0);
      if (worst < 1e-10) {
        this.angle = [this.own.angles(this.state, this.angle[0]), this.probe.angles(this.state, this.angle[1])];
        return true;
      }
      const twist = leastNorm(rows, all), largest = Math.max(...twist.map(Math.abs)), damp = Math.min(1, 0.3 / largest);
      this.state = this.state.map((frame, i) => {
        const w = [0, 1, 2].map((j) => -damp * twist[6 * i + 3 + j]), angle = Math.hypot(...w);
        const half = angle > 1e-12 ? Math.sin(angle / 2) / angle : 0.5;
        const center = this.own.center[i], at = Frame.point(frame, center);
        const turned = Frame.times(Frame.quaternion([w[0] * half, w[1] * half, w[2] * half, Math.cos(angle / 2)], NONE),
          [frame[0], frame[1], frame[2], 0, frame[4], frame[5], frame[6], 0, frame[8], frame[9], frame[10], 0]);
        const goal = at.map((x, j) => x - damp * twist[6 * i + j] * this.own.length[i]);
        const carried = Frame.direction(turned, center);
        for (let j = 0; j < 3; j++) turned[4 * j + 3] = goal[j] - carried[j];
        return turned;
      });
    }
    return false;
  }
}

class Mechanism {
  constructor(data, array) {
    const kinds = { joint: JointBlock, curve: CurveBlock, solve: SolvedBlock };
    this.coordinates = data.coordinates;
    this.q = {};
    for (const [name, c] of Object.entries(data.coordinates)) this.q[name] = c.value;
    this.blocks = data.blocks.map((b) => ({ root: b.root, bodies: b.bodies, data: b, mover: new kinds[b.mode](b, array) }));
    this.displaced = Array.from({ length: data.bodyCount }, Frame.identity);
    this.freedoms = this.blocks.flatMap((b) => b.data.held);
    this.blockOf = {};
    for (const block of this.blocks) for (const name of block.data.coordinates) this.blockOf[name] = block;
    this.range = {};
    for (const name of this.freedoms) this.range[name] = this.reach(name);
    this.update();
  }
  // [low, high, endless] of a freedom.
  reach(name) {
    const c = this.coordinates[name], block = this.blockOf[name].data;
    if (block.mode === "curve") return [block.low, block.high, block.whole];
    const far = c.unit === "deg" ? Math.PI : Math.max(2 * c.size, 1e-3);
    return [c.lower ?? (c.upper ?? c.value + far) - 2 * far, c.upper ?? (c.lower ?? c.value - far) + 2 * far,
      c.unit === "deg" && c.lower === null && c.upper === null];
  }
  update(only = null) {
    for (const block of this.blocks) {
      if (!only || only.has(block)) block.relative = block.mover.move(this.q);
      const root = this.displaced[block.root];
      block.bodies.forEach((body, i) => (this.displaced[body] = Frame.times(root, block.relative[i])));
    }
  }
  // Set freedoms, each within its range, and move what hangs on them; where another joint's limit is met, stay.
  set(values) {
    const touched = new Set(), before = { ...this.q };
    for (const [name, value] of Object.entries(values)) {
      const [low, high, endless] = this.range[name];
      this.q[name] = endless ? value : Math.min(high, Math.max(low, value));
      touched.add(this.blockOf[name]);
    }
    this.update(touched);
    for (const block of touched) {
      if (block.data.mode !== "solve") continue;
      const past = (name) => {
        const c = this.coordinates[name], slack = 1e-9;
        return (c.upper !== null && this.q[name] > Math.max(c.upper, before[name]) + slack)
          || (c.lower !== null && this.q[name] < Math.min(c.lower, before[name]) - slack);
      };
      if (block.data.coordinates.some(past)) {
        for (const name of block.data.coordinates) this.q[name] = before[name];
        this.update(new Set([block]));
      }
    }
  }
  shown(name) {
    const c = this.coordinates[name];
    return c.unit === "deg" ? (this.q[name] * 180) / Math.PI : this.q[name];
  }
  // The freedoms that a body's place depends on.
  above(body) {
    const found = [];
    for (let at = body; at; ) {
      const block = this.blocks.find((b) => b.bodies.includes(at));
      if (!block) break;
      found.push(...block.data.held);
      at = block.root;
    }
    return found;
  }
  // Pull a point of a body (where it is in the closed pose) towards a place.
  pull(body, point, goal) {
    const names = this.above(body);
    const at = () => Frame.point(this.displaced[body], point);
    for (let round = 0; round < 6 && names.length; round++) {
      const here = at(), off = minus(goal, here), rates = [];
      if (Math.hypot(...off) < 1e-9) return;
      const start = Object.fromEntries(names.map((n) => [n, this.q[n]]));
      for (const name of names) {
        const small = this.coordinates[name].unit === "deg" ? 1e-5 : 1e-6, [low, high, endless] = this.range[name];
        const step = !endless && start[name] + small > high ? -small : small;
        this.set({ [name]: start[name] + step });
        rates.push(scaled(minus(at(), here), 1 / step));
        this.set(start);
      }
      const size = rates.map((r) => dot(r, r)), damp = 1e-4 * Math.max(...size) + 1e-12;
      const rows = [0, 1, 2].map((i) => Float64Array.from(rates.map((r) => r[i])));
      const weight = rates.map((r) => 1 / Math.sqrt(dot(r, r) + damp));
      const step = leastNorm(rows.map((row) => row.map((x, i) => x * weight[i])), off).map((x, i) => x * weight[i]);
      const goalOf = {};
      names.forEach((name, i) => {
        const most = this.coordinates[name].unit === "deg" ? 0.3 : Math.hypot(...off);
        goalOf[name] = start[name] + Math.min(most, Math.max(-most, step[i]));
      });
      this.set(goalOf);
      if (Math.hypot(...minus(goal, at())) > Math.hypot(...off) * 1.0001) {
        const half = {};
        for (const name of names) half[name] = start[name] + 0.25 * (goalOf[name] - start[name]);
        this.set(half);
        if (Math.hypot(...minus(goal, at())) > Math.hypot(...off)) {
          this.set(start);
          return;
        }
      }
    }
  }
}
