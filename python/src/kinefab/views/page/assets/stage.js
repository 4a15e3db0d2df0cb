// The drawn scene: parts with edges, light and shadow, camera, picking.  The world is right-handed, +Y up.
/* global THREE */

const CREASE = Math.cos((30 * Math.PI) / 180);
const MOST_EDGED = 400000; // triangles of one mesh beyond which it has no edges
const SHADOWED = 300000; // triangles of the whole beyond which nothing casts a shadow
const MOST_LINED = 500; // parts beyond which edges are left out while anything moves
const EDGES = 1; // their layer
const STILL = 200; // milliseconds without a movement after which they come back

// Positions, smooth normals within creases, and feature edges of an indexed mesh.
function shaded(mesh, array) {
  const packed = array(mesh.p), index = array(mesh.i), count = packed.length / 3;
  const place = new Float32Array(packed.length);
  for (let i = 0; i < count; i++)
    for (let j = 0; j < 3; j++) place[3 * i + j] = mesh.low[j] + (packed[3 * i + j] / 65535) * mesh.span[j];
  const weld = new Map(), same = new Uint32Array(count);
  for (let i = 0; i < count; i++) {
    const key = packed[3 * i] + 65536 * (packed[3 * i + 1] + 65536 * packed[3 * i + 2]);
    if (!weld.has(key)) weld.set(key, i);
    same[i] = weld.get(key);
  }
  const faces = index.length / 3, normal = new Float32Array(3 * faces), area = new Float32Array(faces);
  for (let f = 0; f < faces; f++) {
    const [a, b, c] = [3 * index[3 * f], 3 * index[3 * f + 1], 3 * index[3 * f + 2]];
    const ux = place[b] - place[a], uy = place[b + 1] - place[a + 1], uz = place[b + 2] - place[a + 2];
    const vx = place[c] - place[a], vy = place[c + 1] - place[a + 1], vz = place[c + 2] - place[a + 2];
    const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx, size = Math.hypot(x, y, z) || 1;
    normal[3 * f] = x / size; normal[3 * f + 1] = y / size; normal[3 * f + 2] = z / size;
    area[f] = size;
  }
  const start = new Uint32Array(count + 1), around = new Uint32Array(index.length);
  for (const i of index) start[same[i] + 1]++;
  for (let i = 0; i < count; i++) start[i + 1] += start[i];
  const next = start.slice();
  for (let k = 0; k < index.length; k++) around[next[same[index[k]]]++] = (k / 3) | 0;
  // One vertex for all corners of a place that have the same normal.
  const corners = new Uint32Array(index.length), positions = [], normals = [], other = [], latest = new Int32Array(count).fill(-1);
  for (let k = 0; k < index.length; k++) {
    const f = (k / 3) | 0, v = same[index[k]], nx = normal[3 * f], ny = normal[3 * f + 1], nz = normal[3 * f + 2];
    let x = 0, y = 0, z = 0;
    for (let s = start[v]; s < start[v + 1]; s++) {
      const g = around[s], a = normal[3 * g], b = normal[3 * g + 1], c = normal[3 * g + 2];
      if (a * nx + b * ny + c * nz > CREASE) { x += area[g] * a; y += area[g] * b; z += area[g] * c; }
    }
    const size = Math.hypot(x, y, z) || 1;
    x /= size; y /= size; z /= size;
    let made = latest[v];
    while (made >= 0 && Math.abs(normals[3 * made] - x) + Math.abs(normals[3 * made + 1] - y) + Math.abs(normals[3 * made + 2] - z) > 1e-5)
      made = other[made];
    if (made < 0) {
      made = other.length;
      other.push(latest[v]);
      latest[v] = made;
      positions.push(place[3 * v], place[3 * v + 1], place[3 * v + 2]);
      normals.push(x, y, z);
    }
    corners[k] = made;
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(new THREE.BufferAttribute(other.length > 65535 ? corners : Uint16Array.from(corners), 1));
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
  geometry.setAttribute("normal", new THREE.Float32BufferAttribute(normals, 3));
  mesh.groups.forEach(([first, length], i) => geometry.addGroup(first, length, i));
  geometry.computeBoundingSphere();
  geometry.computeBoundingBox();
  return { geometry, edges: faces <= MOST_EDGED ? creases(place, index, same, normal) : null, triangles: faces };
}

function creases(place, index, same, normal) {
  const seen = new Map(), lines = [];
  const draw = (a, b) => { for (const v of [a, b]) lines.push(place[3 * v], place[3 * v + 1], place[3 * v + 2]); };
  for (let k = 0; k < index.length; k++) {
    const f = (k / 3) | 0, a = same[index[k]], b = same[index[k % 3 === 2 ? k - 2 : k + 1]];
    if (a === b) continue;
    const key = a < b ? a * 4294967296 + b : b * 4294967296 + a, other = seen.get(key);
    if (other === undefined) { seen.set(key, f); continue; }
    seen.delete(key);
    const cosine = normal[3 * f] * normal[3 * other] + normal[3 * f + 1] * normal[3 * other + 1] + normal[3 * f + 2] * normal[3 * other + 2];
    if (cosine < CREASE) draw(a, b);
  }
  for (const key of seen.keys()) draw(Math.floor(key / 4294967296), key % 4294967296);
  const edges = new THREE.BufferGeometry();
  edges.setAttribute("position", new THREE.Float32BufferAttribute(lines, 3));
  return edges;
}

function asMatrix(frame, matrix = new THREE.Matrix4()) {
  const [a, b, c, x, d, e, f, y, g, h, i, z] = frame;
  return matrix.set(a, b, c, x, d, e, f, y, g, h, i, z, 0, 0, 0, 1);
}

class Stage {
  constructor(canvas, data, array) {
    this.data = data;
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(28, 1, 0.01, 100);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => this.draw());
    this.parts = data.parts.map(() => null);
    this.bars = [];
    this.bodies = Array.from({ length: data.bodyCount }, () => {
      const group = new THREE.Group();
      group.matrixAutoUpdate = false;
      this.scene.add(group);
      return group;
    });
    this.overlay = new THREE.Group();
    this.scene.add(this.overlay);
    const made = new Map();
    this.materials = new Map();
    this.triangles = this.lined = 0;
    this.camera.layers.enable(EDGES);
    this.edgeMaterial = new THREE.LineBasicMaterial({ color: 0x101418, transparent: true, opacity: 0.75 });
    data.parts.forEach((part, i) => {
      if (part.mesh === null) return;
      if (!made.has(part.mesh)) made.set(part.mesh, shaded(data.meshes[part.mesh], array));
      const { geometry, edges, triangles } = made.get(part.mesh);
      this.triangles += triangles;
      const group = new THREE.Group();
      group.matrixAutoUpdate = false;
      group.matrix.copy(asMatrix(part.pose));
      const surfaces = data.meshes[part.mesh].groups.map((_, k) => part.materials[k]);
      const mesh = new THREE.Mesh(geometry, surfaces.map((surface) => this.material(surface)));
      mesh.userData.part = i;
      mesh.castShadow = mesh.receiveShadow = true;
      group.add(mesh);
      if (edges) {
        const lines = new THREE.LineSegments(edges, this.edgeMaterial);
        lines.layers.set(EDGES);
        group.add(lines);
        this.lined++;
      }
      for (const child of group.children) child.matrixAutoUpdate = false;
      this.bodies[part.body].add(group);
      this.parts[i] = { group, mesh, surfaces, shown: part.shown, ghost: false };
      group.visible = part.shown;
    });
    this.bounds();
    this.light();
    this.resize();
    this.fit();
  }
  // One for all parts that look the same: the renderer sets up each of them once a frame.
  material(index, { ghost = false, glow = false, tint = null } = {}) {
    const key = [index, ghost, glow, tint].join();
    if (this.materials.has(key)) return this.materials.get(key);
    const given = index === undefined ? null : this.data.materials[index];
    const [r, g, b, a] = given ? given.color : [0.55, 0.57, 0.6, 1];
    const material = new THREE.MeshStandardMaterial({
      roughness: given ? Math.max(0.35, 0.95 - 0.6 * given.smoothness) : 0.6, metalness: 0,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1, side: THREE.DoubleSide,
    });
    if (tint) material.color.set(tint);
    else material.color.setRGB(r, g, b);
    material.opacity = ghost ? 0.14 : a;
    material.transparent = material.opacity < 1;
    material.depthWrite = !ghost;
    material.emissive.set(glow ? 0x1f6feb : 0x000000);
    material.emissiveIntensity = glow ? 0.55 : 0;
    this.materials.set(key, material);
    return material;
  }
  bounds() {
    this.scene.updateMatrixWorld(true);
    this.box = new THREE.Box3();
    this.parts.forEach((part) => { if (part && part.shown) this.box.expandByObject(part.mesh); });
    for (const joint of this.data.joints) this.box.expandByPoint(new THREE.Vector3(joint.at[3], joint.at[7], joint.at[11]));
    if (this.box.isEmpty()) this.box.set(new THREE.Vector3(-0.5, -0.5, -0.5), new THREE.Vector3(0.5, 0.5, 0.5));
    this.size = Math.max(this.box.getSize(new THREE.Vector3()).length(), 1e-6);
    this.center = this.box.getCenter(new THREE.Vector3());
    this.reached = this.corners();
  }
  light() {
    const size = this.size;
    this.sky = new THREE.HemisphereLight(0xffffff, 0x8890a0, 1.5);
    this.sun = new THREE.DirectionalLight(0xffffff, 2.2);
    this.sun.position.copy(this.center).add(new THREE.Vector3(0.5, 1.1, 0.75).multiplyScalar(size));
    this.sun.target.position.copy(this.center);
    const fill = new THREE.DirectionalLight(0xdfe8ff, 0.55);
    fill.position.copy(this.center).add(new THREE.Vector3(-0.9, 0.4, -0.5).multiplyScalar(size));
    this.scene.add(this.sky, this.sun, this.sun.target, fill);
    if (this.triangles > SHADOWED) return;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    const reach = 0.75 * size, camera = this.sun.shadow.camera;
    Object.assign(camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.1 * size, far: 3 * size });
    this.sun.shadow.normalBias = 0.002 * size;
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.radius = 5;
    const floor = new THREE.Mesh(new THREE.PlaneGeometry(12 * size, 12 * size), new THREE.ShadowMaterial({ opacity: 0.16 }));
    floor.rotation.x = -Math.PI / 2;
    floor.position.set(this.center.x, this.box.min.y - 0.004 * size, this.center.z);
    floor.receiveShadow = true;
    this.scene.add(floor);
  }
  // The corners of all that is shown, or of some parts, where the bodies stand now.
  corners(parts = null) {
    this.scene.updateMatrixWorld(true);
    const found = [];
    this.parts.forEach((part, i) => {
      if (!part || !part.shown || (parts && !parts.includes(i))) return;
      const { min, max } = part.mesh.geometry.boundingBox;
      for (const x of [min.x, max.x]) for (const y of [min.y, max.y]) for (const z of [min.z, max.z])
        found.push(new THREE.Vector3(x, y, z).applyMatrix4(part.mesh.matrixWorld));
    });
    if (!parts) for (const joint of this.data.joints) for (const [body, at] of [[joint.a, joint.at], [joint.b, joint.atB]])
      found.push(new THREE.Vector3(at[3], at[7], at[11]).applyMatrix4(this.bodies[body].matrixWorld));
    return found;
  }
  // Make room for everything at these poses too.
  include(displaced) {
    displaced.forEach((frame, body) => asMatrix(frame, this.bodies[body].matrix));
    this.reached.push(...this.corners());
  }
  theme(dark) {
    this.scene.background = new THREE.Color(dark ? 0x15181d : 0xf3f5f8);
    this.edgeMaterial.color.set(dark ? 0x05070a : 0x1d242c);
    this.sky.groundColor.set(dark ? 0x4a5260 : 0x98a0ae);
    this.draw();
  }
  fit(parts = null) {
    const points = parts ? this.corners(parts) : this.reached;
    if (!points.length) return;
    const away = new THREE.Vector3(...this.data.look).normalize();
    const right = new THREE.Vector3(0, 1, 0).cross(away).normalize(), up = away.clone().cross(right);
    const ends = [right, up, away].map((axis) => {
      const along = points.map((p) => p.dot(axis));
      return [Math.min(...along), Math.max(...along)];
    });
    const center = new THREE.Vector3();
    [right, up, away].forEach((axis, i) => center.addScaledVector(axis, (ends[i][0] + ends[i][1]) / 2));
    const tall = Math.tan((0.5 * this.camera.fov * Math.PI) / 180), wide = tall * this.camera.aspect;
    let distance = 0.02 * this.size;
    for (const point of points) {
      const corner = point.clone().sub(center), depth = corner.dot(away);
      distance = Math.max(distance, depth + Math.abs(corner.dot(right)) / wide, depth + Math.abs(corner.dot(up)) / tall);
    }
    distance *= 1.06;
    this.controls.target.copy(center);
    this.camera.position.copy(center).addScaledVector(away, distance);
    Object.assign(this.camera, { near: distance / 200, far: distance * 20 + 10 * this.size });
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }
  resize() {
    const box = this.canvas.parentElement.getBoundingClientRect();
    if (!box.width || !box.height) return;
    const most = this.triangles > 2 * SHADOWED ? 1 : 2;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, most));
    this.renderer.setSize(box.width, box.height, false);
    this.camera.aspect = box.width / box.height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }
  draw() {
    if (this.lined > MOST_LINED) {
      this.camera.layers.disable(EDGES);
      clearTimeout(this.still);
      this.still = setTimeout(() => { this.camera.layers.enable(EDGES); this.ask(); }, STILL);
    }
    this.ask();
  }
  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.now();
    });
  }
  now() {
    this.before && this.before();
    this.renderer.render(this.scene, this.camera);
    this.after && this.after();
  }
  // Bodies at their displacements.
  place(displaced) {
    displaced.forEach((frame, body) => {
      asMatrix(frame, this.bodies[body].matrix);
      this.bodies[body].matrixWorldNeedsUpdate = true;
    });
    this.draw();
  }
  look(i, { shown, ghost, glow, tint }) {
    const part = this.parts[i];
    if (!part) return;
    Object.assign(part, { shown, ghost });
    part.group.visible = shown;
    part.group.children.forEach((child) => { if (child.isLineSegments) child.visible = !ghost; });
    part.mesh.castShadow = !ghost;
    part.mesh.material = part.surfaces.map((surface) => this.material(surface, { ghost, glow, tint }));
  }
  ray(x, y) {
    const box = this.canvas.getBoundingClientRect(), caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2(((x - box.left) / box.width) * 2 - 1, 1 - ((y - box.top) / box.height) * 2), this.camera);
    return caster;
  }
  // What is under a point of the screen: {part, point} or null; ghosts and hidden parts are seen through.
  pick(x, y) {
    const solid = this.parts.filter((part) => part && part.shown && !part.ghost).map((part) => part.mesh);
    const hit = this.ray(x, y).intersectObjects([...solid, ...this.bars], false)[0];
    return hit ? { part: hit.object.userData.part, point: hit.point, distance: hit.distance } : null;
  }
  // Where a world point is on the canvas, in CSS pixels.
  screen(point) {
    const at = new THREE.Vector3(...point).project(this.camera), box = this.canvas.getBoundingClientRect();
    return { x: ((at.x + 1) / 2) * box.width, y: ((1 - at.y) / 2) * box.height, front: at.z < 1 };
  }
}
