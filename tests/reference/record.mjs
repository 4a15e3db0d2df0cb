// Writes traces.json: what PhysX 4.1.2 makes of every scenario.
import fs from "node:fs";
import { traces } from "./traces.mjs";

const lines = Object.entries(await traces()).map(([name, trace]) => `  ${JSON.stringify(name)}: ${JSON.stringify(trace)}`);
fs.writeFileSync(new URL("traces.json", import.meta.url), `{\n${lines.join(",\n")}\n}\n`);
