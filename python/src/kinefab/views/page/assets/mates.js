// Found mates as numbers where they are: blue while switched on, grey while off, orange the one that is chosen.
/* global THREE */

const MATE_COLOURS = { on: "#1f6feb", off: "#868e96", chosen: "#e8590c" };
const MATE_SIZE = 0.01; // half of it, of what the camera sees at a distance of one

class MateNumbers {
  constructor(stage, data) {
    this.stage = stage;
    this.chosen = null;
    const places = new Map();
    this.items = (data.mates ? data.mates.constraints : []).flatMap((mate) => {
      const side = mate.a || {}, part = data.parts.find((p) => p.id === side.component);
      if (!part || !side.p) return [];
      const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ depthTest: false, sizeAttenuation: false, transparent: true }));
      sprite.position.set(...side.p); // in the world at the start, where the bodies' own frames stand
      // Several at one place stand beside each other.
      const key = side.p.map((x) => Math.round((200 * x) / stage.size)).join(), beside = places.get(key) || 0;
      places.set(key, beside + 1);
      sprite.center.set(0.5 - 1.08 * beside, 0.5);
      sprite.scale.set(2 * MATE_SIZE, 2 * MATE_SIZE, 1);
      sprite.renderOrder = 8;
      sprite.visible = false;
      stage.bodies[part.body].add(sprite);
      return [{ mate, sprite, drawn: null }];
    });
  }
  show(on) {
    for (const item of this.items) {
      item.sprite.visible = on;
      const look = this.chosen === item.mate ? "chosen" : item.mate.enabled !== false ? "on" : "off";
      if (!on || item.drawn === look) continue;
      if (item.sprite.material.map) item.sprite.material.map.dispose();
      item.sprite.material.map = this.label(String(item.mate.number), MATE_COLOURS[look]);
      item.sprite.material.needsUpdate = true;
      item.drawn = look;
    }
    this.stage.draw();
  }
  label(text, colour) {
    const canvas = document.createElement("canvas"), size = (canvas.width = canvas.height = 64), pen = canvas.getContext("2d");
    pen.fillStyle = colour;
    pen.beginPath();
    pen.arc(size / 2, size / 2, size / 2 - 1, 0, 2 * Math.PI);
    pen.fill();
    pen.fillStyle = "#fff";
    pen.font = `600 ${text.length < 3 ? 34 : 24}px system-ui, sans-serif`;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillText(text, size / 2, size / 2 + 2);
    const map = new THREE.CanvasTexture(canvas);
    map.colorSpace = THREE.SRGBColorSpace;
    return map;
  }
  pick(x, y) {
    const hit = this.stage.ray(x, y).intersectObjects(this.items.map((item) => item.sprite).filter((sprite) => sprite.visible), false)[0];
    return hit ? this.items.find((item) => item.sprite === hit.object).mate : null;
  }
}
