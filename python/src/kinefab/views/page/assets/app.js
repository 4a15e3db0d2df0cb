// The page: panels, sliders, play, selection, drag.  All names come from a file: they are only ever set as text.
/* global THREE, Stage, Glyphs, MateNumbers, Mechanism, Frame */

const $ = (id) => document.getElementById(id);

function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (key === "class") made.className = value;
    else made.setAttribute(key, value);
  }
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

async function unpacked() {
  const text = $("blob").textContent.trim();
  if (!text) return new ArrayBuffer(0);
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
}

const TYPES = { f4: Float32Array, f8: Float64Array, u2: Uint16Array, u4: Uint32Array, i4: Int32Array };
const MOST_GLYPHS = 300; // joints beyond which none is drawn until asked for
const ISLANDS = ["#4dabf7", "#ffa94d", "#69db7c", "#da77f2", "#ffd43b", "#ff8787", "#38d9a9", "#a9e34b", "#748ffc", "#e599f7"];

class App {
  constructor(data, buffer) {
    const array = (ref) => (Array.isArray(ref) ? ref : new TYPES[ref.t](buffer, ref.o, ref.n));
    data.array = array;
    this.data = data;
    this.mechanism = new Mechanism(data, array);
    this.stage = new Stage($("view"), data, array);
    this.glyphs = new Glyphs(this.stage, this.mechanism, data);
    this.numbers = new MateNumbers(this.stage, data);
    this.home = { ...this.mechanism.q };
    this.reach();
    this.state = data.parts.map((part) => ({ shown: part.shown, ghost: false }));
    this.playing = new Set(this.mechanism.freedoms.slice(0, 1));
    this.phase = {};
    this.wanted = { joints: data.joints.length <= MOST_GLYPHS, closures: true, couplings: true, colliders: false, islands: false };
    this.tab = "parts";
    this.closed = new Set();
    this.children = data.parts.map(() => []);
    data.parts.forEach((part, i) => { if (part.parent !== null) this.children[part.parent].push(i); });
    this.head();
    this.freedoms();
    this.bind();
    this.theme(matchMedia("(prefers-color-scheme: dark)").matches);
    this.glyphs.show(this.wanted);
    this.list();
    this.detail();
    this.moved();
  }
  head() {
    $("title").textContent = this.data.title;
    $("subtitle").textContent = this.data.subtitle;
    $("mobility").textContent = this.data.mobility;
    if (this.data.notices.length) $("notice").append(element("span", {}, this.data.notices.join("  ")));
    $("hint").textContent = this.mechanism.freedoms.length
      ? "Drag a part to move it · drag beside it to orbit · wheel to zoom · Space plays" : "No joint of this scene can move · drag to orbit";
    $("matesTab").hidden = !this.data.mates;
    $("glyphs").setAttribute("aria-pressed", this.wanted.joints);
    $("play").disabled = $("trace").disabled = !this.mechanism.freedoms.length;
  }
  // Look at all that the first freedoms sweep over.
  reach() {
    if (this.data.parts.length > 400) return;
    for (const name of this.mechanism.freedoms.slice(0, 3)) {
      const [low, high] = this.mechanism.range[name];
      for (let k = 0; k < 8; k++) {
        this.mechanism.set({ [name]: low + ((high - low) * k) / 7 });
        this.stage.include(this.mechanism.displaced);
      }
      this.mechanism.set({ [name]: this.home[name] });
    }
    this.stage.fit();
  }
  theme(dark) {
    this.dark = dark;
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    this.stage.theme(dark);
  }

  // On paper the mechanism is a picture of how it stands now, on white.
  print() {
    const dark = this.dark;
    this.theme(false);
    this.stage.scene.background.set(0xffffff);
    this.stage.now();
    $("printed").src = $("view").toDataURL("image/png");
    addEventListener("afterprint", () => this.theme(dark), { once: true });
  }

  // Freedoms ----------------------------------------------------------------------------------------------------------
  freedoms() {
    this.sliders = {};
    const box = $("freedoms");
    box.replaceChildren();
    // Of thousands of sliders only those in sight follow at once.
    this.inSight = new Set();
    const watcher = new IntersectionObserver((seen) => {
      for (const { target, isIntersecting } of seen) {
        const name = target.dataset.name;
        isIntersecting ? this.inSight.add(name) : this.inSight.delete(name);
        this.follow(name);
      }
    });
    if (!this.mechanism.freedoms.length) box.append(element("p", { class: "follow" }, "No joint of this scene can move."));
    for (const name of this.mechanism.freedoms) {
      const c = this.data.coordinates[name], [low, high, endless] = this.mechanism.range[name];
      const unit = c.unit === "deg" ? 180 / Math.PI : 1, digits = c.unit === "deg" ? 2 : 5;
      const range = element("input", { type: "range", min: low * unit, max: high * unit, step: "any", "aria-label": c.label });
      const number = element("input", { type: "number", step: c.unit === "deg" ? 1 : 0.001, "aria-label": `${c.label}, ${c.unit}` });
      const check = element("input", { type: "checkbox", title: "Play this one", "aria-label": `play ${c.label}` });
      check.checked = this.playing.has(name);
      const set = (value) => { this.mechanism.set({ [name]: value / unit }); this.phase = {}; this.moved(); };
      range.addEventListener("input", () => set(Number(range.value)));
      number.addEventListener("change", () => number.value !== "" && set(Number(number.value)));
      check.addEventListener("change", () => { check.checked ? this.playing.add(name) : this.playing.delete(name); this.phase = {}; });
      const text = element("label", { title: c.label, onclick: () => this.choose({ joint: c.joint }) }, c.label);
      const ends = [low, high].map((x) => element("span", {}, `${(x * unit).toFixed(digits - 1)}`));
      const note = endless ? "all the way round" : c.lower !== null || c.upper !== null ? "limits" : "its reach";
      const row = element("div", { class: "freedom" },
        element("div", { class: "top" }, check, text, number, element("span", {}, c.unit === "deg" ? "°" : "m")),
        range, element("div", { class: "ends" }, ends[0], element("span", {}, note), ends[1]));
      row.dataset.name = name;
      box.append(row);
      watcher.observe(row);
      this.sliders[name] = { range, number, unit, digits, low, high, endless };
      this.follow(name);
    }
    this.followers = element("div");
    box.append(this.followers);
  }
  // A freedom's slider and number show where it stands.
  follow(name) {
    const slider = this.sliders[name], value = this.mechanism.q[name];
    if (slider.last === value) return;
    slider.last = value;
    const span = slider.high - slider.low;
    const shown = slider.endless ? slider.low + ((((value - slider.low) % span) + span) % span) : value;
    slider.range.value = shown * slider.unit;
    if (document.activeElement !== slider.number) slider.number.value = (value * slider.unit).toFixed(slider.digits);
  }
  moved() {
    this.stage.place(this.mechanism.displaced);
    this.glyphs.follow();
    for (const name of this.inSight) this.follow(name);
    const chosen = this.chosen && this.chosen.joint !== undefined ? this.data.joints[this.chosen.joint] : null;
    this.followers.replaceChildren();
    if (chosen) for (const f of chosen.freedoms) if (f.name && !this.sliders[f.name]) {
      const c = this.data.coordinates[f.name];
      this.followers.append(element("div", { class: "follow" }, element("span", {}, c.label),
        element("b", {}, `${this.mechanism.shown(f.name).toFixed(c.unit === "deg" ? 2 : 5)} ${c.unit === "deg" ? "°" : "m"}`)));
    }
  }

  // Selection ---------------------------------------------------------------------------------------------------------
  choose(what) {
    this.chosen = what;
    this.glyphs.select(what && what.joint !== undefined ? this.data.joints[what.joint] : null);
    this.numbers.chosen = (what && what.mate) || null;
    this.looks();
    this.list();
    this.detail();
    this.moved();
  }
  glowing() {
    const glowing = new Set();
    const add = (i) => { glowing.add(i); this.children[i].forEach(add); };
    if (this.chosen && this.chosen.part !== undefined) add(this.chosen.part);
    for (const i of (this.chosen && this.chosen.parts) || []) add(i);
    return glowing;
  }
  looks() {
    const glowing = this.glowing();
    this.data.parts.forEach((part, i) => {
      const island = this.wanted.islands ? this.data.islandOf[part.body] : null;
      const tint = island === null || island === undefined ? (this.wanted.islands ? "#8a929c" : null) : ISLANDS[island % ISLANDS.length];
      this.stage.look(i, { ...this.state[i], glow: glowing.has(i), tint });
    });
    this.stage.draw();
  }
  change(i, change) {
    const go = (k) => { Object.assign(this.state[k], change); this.children[k].forEach(go); };
    go(i);
    this.looks();
    this.list();
  }
  isolate(i) {
    const kept = new Set(), add = (k) => { kept.add(k); this.children[k].forEach(add); };
    if (i !== null) add(i);
    this.state.forEach((state, k) => { state.shown = i === null ? this.data.parts[k].shown : kept.has(k); state.ghost = false; });
    this.looks();
    this.list();
  }

  // Left panel --------------------------------------------------------------------------------------------------------
  list() {
    const box = $("list"), search = $("search").value.trim().toLowerCase();
    $("search").hidden = this.tab === "report";
    box.replaceChildren();
    document.querySelectorAll("nav button").forEach((b) => {
      b.classList.toggle("on", b.dataset.tab === this.tab);
      b.setAttribute("aria-selected", b.dataset.tab === this.tab);
    });
    this.numbers.show(this.tab === "mates");
    if (this.tab === "parts") {
      const found = (i) => !search || this.data.parts[i].name.toLowerCase().includes(search) || this.children[i].some(found);
      const rows = [];
      const add = (i, depth) => {
        if (!found(i) || rows.length > 3000) return;
        rows.push(this.partRow(i, depth));
        if (search || !this.closed.has(i)) this.children[i].forEach((k) => add(k, depth + 1));
      };
      this.data.parts.forEach((part, i) => part.parent === null && add(i, 0));
      box.append(...rows);
    } else if (this.tab === "joints") {
      this.data.joints.forEach((joint, i) => {
        if (search && !joint.label.toLowerCase().includes(search)) return;
        const dot = element("span", { class: "dot" });
        dot.style.background = { HingeJoint: "#e8590c", ConfigurableJoint: "#1c7ed6" }[joint.type] || "#868e96";
        box.append(this.row(this.chosen && this.chosen.joint === i && !this.chosen.coupling, "", joint.label,
          () => this.choose({ joint: i }), dot, element("span", { class: "name" }, joint.label), element("small", {}, joint.kind)));
      });
      for (const coupling of this.data.couplings)
        box.append(this.row(this.chosen && this.chosen.coupling === coupling, "", coupling.text,
          () => this.choose({ joint: coupling.joints[0], coupling }),
          element("span", { class: "name" }, coupling.text), element("small", {}, coupling.kind)));
      if (!this.data.joints.length) box.append(element("p", { class: "entry" }, "There are no joints."));
    } else if (this.tab === "mates") {
      box.append(...this.mateRows());
    } else {
      const order = { dropped: 0, approximated: 1, kept: 2 };
      const entries = this.data.report.slice().sort((a, b) => order[a.outcome] - order[b.outcome]);
      for (const entry of entries.slice(0, 2000)) box.append(this.reportEntry(entry));
      if (!entries.length) box.append(element("p", { class: "entry" }, "The scene carries no report."));
    }
    const on = box.querySelector(".on");
    if (on) on.id = "chosen";
    box.setAttribute("aria-activedescendant", on ? "chosen" : "");
    if (on && document.activeElement === box) on.scrollIntoView({ block: "nearest" });
  }
  row(on, look, title, run, ...content) {
    return element("div", { class: `row${look}${on ? " on" : ""}`, role: "option", "aria-selected": Boolean(on), title, onclick: run }, ...content);
  }
  // The list by keys: up and down choose, right and left unfold and fold.
  walk(event) {
    const rows = [...$("list").querySelectorAll("[role=option]")], now = rows.findIndex((row) => row.classList.contains("on"));
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key], fold = { ArrowRight: "delete", ArrowLeft: "add" }[event.key];
    if (event.target !== $("list")) return;
    if (step && rows.length) rows[Math.max(0, Math.min(rows.length - 1, now + step))].click();
    else if (fold && this.tab === "parts" && now >= 0) { this.closed[fold](this.chosen.part); this.list(); }
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
  // Found mates: each switched on or off, the choice copied as the file that `kinefab export --mates` reads.
  mateRows() {
    const mates = this.data.mates.constraints;
    const copy = element("button", { onclick: () => this.copyMates() }, "Copy the choice as JSON");
    return [element("div", { class: "entry" }, copy), ...mates.map((mate) => {
      const box = element("input", { type: "checkbox", "aria-label": `mate ${mate.number}` });
      box.checked = mate.enabled !== false;
      box.addEventListener("click", (event) => event.stopPropagation());
      box.addEventListener("change", () => { mate.enabled = box.checked; this.numbers.show(true); });
      const names = this.mateParts(mate).map((i) => this.data.parts[i].name).join(" – ");
      return this.row(this.chosen && this.chosen.mate === mate, "", mate.id, () => this.chooseMate(mate), box,
        element("small", {}, String(mate.number)), element("span", { class: "name" }, `${mate.kind}: ${names}`),
        element("small", {}, mate.confidence === undefined ? "" : Number(mate.confidence).toFixed(2)));
    })];
  }
  mateParts(mate) {
    return ["a", "b"].map((side) => mate[side] && this.data.parts.findIndex((part) => part.id === mate[side].component)).filter((i) => i >= 0);
  }
  chooseMate(mate) {
    const parts = this.mateParts(mate), why = mate.rawKind ? ` (${mate.rawKind})` : "";
    const message = `${mate.kind} of ${parts.map((i) => this.data.parts[i].name).join(" – ")}${why}`;
    this.choose({ mate, parts, note: { feature: `Mate ${mate.number}`, message } });
  }
  copyMates() {
    const area = element("textarea", { "aria-hidden": "true" });
    area.value = JSON.stringify(this.data.mates, null, 2);
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
    $("status").textContent = "Copied: save it as NAME.mates.json and give it by --mates.";
    return JSON.stringify(this.data.mates);
  }
  partRow(i, depth) {
    const part = this.data.parts[i], state = this.state[i], stop = (run) => (event) => { event.stopPropagation(); run(); };
    const twist = element("button", { class: "twist", tabindex: -1, "aria-label": "fold" }, this.children[i].length ? (this.closed.has(i) ? "▸" : "▾") : "");
    twist.addEventListener("click", stop(() => { this.closed.has(i) ? this.closed.delete(i) : this.closed.add(i); this.list(); }));
    const act = (text, title, run) => element("button", { class: "act", tabindex: -1, title, "aria-label": title, onclick: stop(run) }, text);
    const row = this.row(this.chosen && this.chosen.part === i, (state.shown ? "" : " off") + (state.ghost ? " faint" : ""), part.id,
      () => this.choose({ part: i }), twist, element("span", { class: "name" }, part.name),
      act(state.ghost ? "◌" : "◍", "Ghost (G)", () => this.change(i, { ghost: !state.ghost, shown: true })),
      act("◎", "Isolate (I)", () => this.isolate(i)),
      act(state.shown ? "●" : "○", "Hide or show (H)", () => this.change(i, { shown: !state.shown })));
    row.addEventListener("dblclick", () => this.focus(i));
    row.style.paddingLeft = `${6 + 14 * depth}px`;
    return row;
  }
  focus(i) {
    const all = [], add = (k) => { all.push(k); this.children[k].forEach(add); };
    add(i);
    this.stage.fit(all);
  }
  reportEntry(entry) {
    const on = this.chosen && this.chosen.entry === entry, what = { parts: entry.parts, entry };
    return element("div", { class: "entry" + (on ? " on" : ""), role: "option", "aria-selected": Boolean(on),
      onclick: () => this.choose(entry.joints.length ? { ...what, joint: entry.joints[0] } : { ...what, note: entry }) },
      element("span", { class: `badge ${entry.outcome}` }, entry.outcome), " ", element("b", {}, entry.feature),
      entry.message ? element("p", {}, entry.message) : null, entry.source ? element("p", {}, entry.source) : null);
  }

  // Detail ------------------------------------------------------------------------------------------------------------
  detail() {
    const box = $("detail"), list = (pairs) => element("dl", {}, ...pairs.flatMap(([k, v]) => [element("dt", {}, k), element("dd", {}, String(v))]));
    box.replaceChildren();
    if (!this.chosen) {
      box.append(element("h2", {}, "The mechanism"), list(this.data.facts));
    } else if (this.chosen.joint !== undefined) {
      const joint = this.data.joints[this.chosen.joint];
      box.append(element("h3", {}, joint.label), element("p", {}, joint.words), element("h4", {}, "In the source"));
      if (joint.because.length) box.append(list(joint.because.map((b) => [b.id, b.text])));
      else box.append(element("p", {}, "The scene does not name what it came from."));
      box.append(element("h4", {}, `In Unity: ${joint.type}`), list(joint.fields));
    } else if (this.chosen.part !== undefined) {
      const i = this.chosen.part, part = this.data.parts[i], state = this.state[i];
      box.append(element("h3", {}, part.name), element("p", {}, part.id), list(part.facts), element("div", { class: "acts" },
        element("button", { onclick: () => this.focus(i) }, "Fit"),
        element("button", { onclick: () => { this.change(i, { shown: !state.shown }); this.detail(); } }, state.shown ? "Hide" : "Show"),
        element("button", { onclick: () => { this.change(i, { ghost: !state.ghost }); this.detail(); } }, state.ghost ? "Solid" : "Ghost"),
        element("button", { onclick: () => this.isolate(i) }, "Isolate"), element("button", { onclick: () => this.isolate(null) }, "Show all")));
    } else if (this.chosen.note) {
      box.append(element("h3", {}, this.chosen.note.feature), element("p", {}, this.chosen.note.message || this.chosen.note.outcome));
    }
  }

  // Playing -----------------------------------------------------------------------------------------------------------
  play(on) {
    this.running = on && this.playing.size > 0;
    $("play").textContent = this.running ? "❚❚" : "▶";
    $("play").setAttribute("aria-label", this.running ? "Pause" : "Play");
    if (!this.running || this.ticking) return;
    this.ticking = true;
    let last = performance.now();
    const tick = (now) => {
      if (!this.running) { this.ticking = false; return; }
      this.advance(Math.min(0.1, (now - last) / 1000) * 2 ** Number($("speed").value));
      last = now;
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }
  // Freedoms with ends swing between them, the others turn on; four seconds each.
  advance(seconds) {
    const goal = {};
    for (const name of this.playing) {
      const [low, high, endless] = this.mechanism.range[name], now = this.mechanism.q[name];
      if (endless) { goal[name] = now + (2 * Math.PI * seconds) / 4; continue; }
      if (this.phase[name] === undefined) this.phase[name] = Math.acos(Math.max(-1, Math.min(1, 1 - (2 * (now - low)) / (high - low || 1))));
      this.phase[name] += (Math.PI * seconds) / 2;
      if (!$("loop").checked && this.phase[name] > Math.PI) { this.phase[name] = 0; this.play(false); }
      goal[name] = low + ((high - low) * (1 - Math.cos(this.phase[name]))) / 2;
    }
    this.mechanism.set(goal);
    this.moved();
  }
  reset() {
    this.play(false);
    this.phase = {};
    this.mechanism.set(Object.fromEntries(this.mechanism.freedoms.map((name) => [name, this.home[name]])));
    this.moved();
  }
  trace() {
    if (!this.touched) { $("status").textContent = "Click a point of a part first."; return null; }
    const names = this.mechanism.above(this.touched.body).filter((name) => this.playing.has(name));
    const used = names.length ? names : this.mechanism.above(this.touched.body).slice(0, 1);
    if (!used.length) { $("status").textContent = "That part does not move."; return null; }
    const path = this.glyphs.trace(this.touched.body, this.touched.point, used);
    this.moved();
    return path;
  }

  // Pointer and keys --------------------------------------------------------------------------------------------------
  bind() {
    addEventListener("beforeprint", () => this.print());
    const canvas = $("view"), stage = this.stage;
    let held = null, down = null;
    canvas.addEventListener("pointerdown", (event) => {
      down = { x: event.clientX, y: event.clientY };
      if (event.button !== 0 || event.shiftKey) return;
      const hit = stage.pick(event.clientX, event.clientY), joint = this.wanted.joints ? this.glyphs.pick(event.clientX, event.clientY) : null;
      this.hit = hit;
      if (!hit || joint !== null) return;
      const body = this.data.parts[hit.part].body;
      const point = Frame.point(Frame.inverse(this.mechanism.displaced[body]), hit.point.toArray());
      this.touched = { body, point };
      if (!this.mechanism.above(body).length) return;
      const normal = stage.camera.getWorldDirection(new THREE.Vector3());
      held = { body, point, plane: new THREE.Plane().setFromNormalAndCoplanarPoint(normal, hit.point) };
      stage.controls.enabled = false;
      canvas.setPointerCapture(event.pointerId);
    }, true);
    canvas.addEventListener("pointermove", (event) => {
      if (!held) return;
      const goal = stage.ray(event.clientX, event.clientY).ray.intersectPlane(held.plane, new THREE.Vector3());
      if (!goal) return;
      this.play(false);
      this.phase = {};
      this.mechanism.pull(held.body, held.point, goal.toArray());
      this.moved();
    });
    const release = (event) => {
      const still = down && Math.hypot(event.clientX - down.x, event.clientY - down.y) < 5;
      held = null;
      stage.controls.enabled = true;
      if (still && event.type === "pointerup" && event.button === 0) {
        const joint = this.wanted.joints ? this.glyphs.pick(event.clientX, event.clientY) : null;
        const mate = this.numbers.pick(event.clientX, event.clientY);
        if (mate) this.chooseMate(mate);
        else if (joint !== null) this.choose({ joint });
        else this.choose(this.hit ? { part: this.hit.part } : null);
      }
      down = null;
    };
    canvas.addEventListener("pointerup", release);
    canvas.addEventListener("pointercancel", release);
    const toggle = (id, key) => $(id).addEventListener("click", () => {
      this.wanted[key] = !this.wanted[key];
      $(id).setAttribute("aria-pressed", this.wanted[key]);
      this.glyphs.show(this.wanted);
      this.looks();
    });
    [["glyphs", "joints"], ["closures", "closures"], ["couplings", "couplings"], ["colliders", "colliders"], ["islands", "islands"]].forEach((pair) => toggle(...pair));
    $("fit").onclick = () => stage.fit();
    $("theme").onclick = () => this.theme(!this.dark);
    $("play").onclick = () => this.play(!this.running);
    $("reset").onclick = () => this.reset();
    $("trace").onclick = () => this.trace();
    $("menu").onclick = () => { $("app").classList.toggle("left"); $("app").classList.remove("right"); };
    $("sliders").onclick = () => { $("app").classList.toggle("right"); $("app").classList.remove("left"); };
    $("speed").oninput = () => ($("speedValue").textContent = `${Number((2 ** Number($("speed").value)).toFixed(2))}×`);
    $("search").oninput = () => this.list();
    document.querySelectorAll("nav button").forEach((b) => (b.onclick = () => { this.tab = b.dataset.tab; this.list(); }));
    const part = (run) => () => this.chosen && this.chosen.part !== undefined && run(this.chosen.part, this.state[this.chosen.part]);
    const keys = { " ": () => this.play(!this.running), f: () => stage.fit(), j: () => $("glyphs").click(), c: () => $("colliders").click(),
      m: () => $("islands").click(), d: () => $("theme").click(), r: () => this.reset(), t: () => this.trace(), Escape: () => { this.glyphs.clearTraces(); this.isolate(null); this.choose(null); },
      h: part((i, s) => this.change(i, { shown: !s.shown })), g: part((i, s) => this.change(i, { ghost: !s.ghost })), i: part((i) => this.isolate(i)),
      ArrowLeft: () => this.nudge(-1), ArrowRight: () => this.nudge(1) };
    $("list").addEventListener("keydown", (event) => this.walk(event));
    // A field keeps what is typed; a button, a box or a slider has its own use for all but letters.
    addEventListener("keydown", (event) => {
      const { tagName, type } = event.target, own = tagName === "BUTTON" || type === "checkbox" || type === "range";
      if (event.ctrlKey || event.metaKey || event.altKey || (tagName === "INPUT" && !own)) return;
      if (own && event.key.length > 1 && event.key !== "Escape" || own && event.key === " ") return;
      const run = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
      if (run) { event.preventDefault(); run(); }
    });
    new ResizeObserver(() => stage.resize()).observe(canvas.parentElement);
    stage.after = () => this.tag();
  }
  nudge(sign) {
    for (const name of this.playing) {
      const step = this.data.coordinates[name].unit === "deg" ? Math.PI / 180 : 0.01 * (this.mechanism.range[name][1] - this.mechanism.range[name][0]);
      this.mechanism.set({ [name]: this.mechanism.q[name] + sign * step });
    }
    this.phase = {};
    this.moved();
  }
  tag() {
    const box = $("labels");
    box.replaceChildren();
    if (!this.chosen || this.chosen.joint === undefined) return;
    const joint = this.data.joints[this.chosen.joint];
    const at = this.stage.screen(Frame.point(this.mechanism.displaced[joint.b], [joint.atB[3], joint.atB[7], joint.atB[11]]));
    if (!at.front) return;
    const tag = element("div", { class: "tag" }, joint.label);
    tag.style.left = `${at.x}px`;
    tag.style.top = `${at.y}px`;
    box.append(tag);
  }
}

unpacked().then((buffer) => {
  const data = JSON.parse($("data").textContent);
  window.kinefab = new App(data, buffer);
  document.body.dataset.ready = "true";
}).catch((error) => {
  $("notice").append(element("span", {}, `This page cannot be shown here: ${error.message}`));
  throw error;
});
