import fs from "node:fs";
import { loadPhysX } from "./physx.mjs";
import { run } from "./scenario.mjs";

/** Runs all scenarios: {name: {bodies: [[px, py, pz, qx, qy, qz, qw, ... one pose a sample], ...], broken?: [step, ...]}}. */
export async function traces() {
  const scenarios = JSON.parse(fs.readFileSync(new URL("scenarios.json", import.meta.url), "utf8"));
  const physx = await loadPhysX();
  return Object.fromEntries(scenarios.map((s) => [s.name, run(physx, s)]));
}
