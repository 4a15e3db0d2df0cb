// Loads PhysX 4.1.2 (the WebAssembly build of @c-frame/physx) headless and gives one scene to play in.
import fs from "node:fs";
import { createRequire } from "node:module";

const require = createRequire(import.meta.url);

export async function loadPhysX() {
  const factory = require("@c-frame/physx/src/physx.release.js");
  const wasmBinary = fs.readFileSync(require.resolve("@c-frame/physx/wasm/physx.release.wasm"));
  const px = await factory({ wasmBinary });
  const version = px.PX_PHYSICS_VERSION;
  if (version !== 0x4010200) {
    throw new Error(`expected PhysX 4.1.2, got ${version.toString(16)}`);
  }
  const foundation = px.PxCreateFoundation(version, new px.PxDefaultAllocator(), new px.PxDefaultErrorCallback());
  const scale = new px.PxTolerancesScale();
  const physics = px.PxCreatePhysics(version, foundation, scale, false, null);
  px.PxInitExtensions(physics, null);
  return { px, physics, scale };
}

// The binding names only some constraint flags; its enums are plain {value} objects, so the others can be passed all the same.
export const ConstraintFlag = {
  projection: { value: 6 },
  driveLimitsAreForces: { value: 32 },
  disablePreprocessing: { value: 256 },
  enableExtendedLimits: { value: 512 },
};

export const transform = ({ position = [0, 0, 0], rotation = [0, 0, 0, 1] } = {}) => ({
  translation: vector(position),
  rotation: { x: rotation[0], y: rotation[1], z: rotation[2], w: rotation[3] },
});

export const vector = ([x, y, z]) => ({ x, y, z });
