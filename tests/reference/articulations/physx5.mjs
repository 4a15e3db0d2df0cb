// Loads PhysX 5.6.1 (the WebAssembly build of physx-js-webidl, which expects a browser) headless.
import fs from "node:fs";
import { createRequire } from "node:module";

export async function loadPhysX5() {
  const require = createRequire(import.meta.url);
  const wasmBinary = fs.readFileSync(require.resolve("physx-js-webidl/physx-js-webidl.wasm"));
  const { default: PhysX } = await import("physx-js-webidl");
  const px = await asInABrowser(() => PhysX({ wasmBinary }));
  const top = px.PxTopLevelFunctions.prototype;
  const version = top.get_PHYSICS_VERSION?.() ?? px.PHYSICS_VERSION ?? top.PHYSICS_VERSION;
  if (version >>> 8 !== 0x050601) {
    throw new Error(`expected PhysX 5.6.1, got ${version.toString(16)}`);
  }
  const foundation = top.CreateFoundation(version, new px.PxDefaultAllocator(), new px.PxDefaultErrorCallback());
  const scale = new px.PxTolerancesScale();
  const physics = top.CreatePhysics(version, foundation, scale);
  top.InitExtensions(physics);
  const dispatcher = top.DefaultCpuDispatcherCreate(0);
  return { px, top, physics, scale, dispatcher };
}

// The build looks for a window and for the absence of Node's version while it starts.
async function asInABrowser(start) {
  const versions = Object.getOwnPropertyDescriptor(process, "versions");
  globalThis.window = globalThis;
  Object.defineProperty(process, "versions", { value: {}, configurable: true });
  try {
    return await start();
  } finally {
    Object.defineProperty(process, "versions", versions);
    delete globalThis.window;
  }
}
