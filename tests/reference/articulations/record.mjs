// Writes traces.json: every scenario with what PhysX 5.6.1 makes of it.
import fs from "node:fs";
import { loadPhysX5 } from "./physx5.mjs";
import { run } from "./run.mjs";
import { scenarios } from "./scenarios.mjs";

const world = await loadPhysX5();
const lines = scenarios.map((scenario) => JSON.stringify({ ...scenario, trace: run(world, scenario) }));
fs.writeFileSync(new URL("traces.json", import.meta.url), `[\n${lines.join(",\n")}\n]\n`);
console.log(`${lines.length} scenarios`);
