// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT
//
//   node bundle.mjs SOURCES OUTPUT enabled|auto
//
// Installs what package-lock.json pins, bundles the page's script and style into OUTPUT/page.js and
// OUTPUT/page.css, and writes the licences of what went in. Where the libraries cannot be had, and the
// option says auto, the script is empty: pages are then written without it, and say so.
import { execFileSync } from "node:child_process";
import { cpSync, existsSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { createRequire } from "node:module";

const [sources, output, wanted] = process.argv.slice(2);
const place = join(resolve(output), "page");

/// A copy of the sources, so that nothing is installed among them.
function install() {
  mkdirSync(place, { recursive: true });
  for (const name of ["src", "package.json", "package-lock.json", ".npmrc"]) {
    cpSync(join(sources, name), join(place, name), { recursive: true, force: true });
  }
  const stamp = join(place, "node_modules", "installed.json");
  const lock = readFileSync(join(place, "package-lock.json"), "utf8");
  if (existsSync(stamp) && readFileSync(stamp, "utf8") === lock) return;
  const options = ["ci", "--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error", "--prefer-offline",
    "--fetch-retries=1", "--fetch-timeout=60000"];
  execFileSync("npm", options, { cwd: place, stdio: ["ignore", "ignore", "pipe"] });
  writeFileSync(stamp, lock);
}

async function bundle() {
  const { build } = createRequire(join(place, "package.json"))("esbuild");
  const { metafile } = await build({
    entryPoints: [join(place, "src", "main.js"), join(place, "src", "page.css")],
    entryNames: "[name]", outdir: place, bundle: true, minify: true, format: "iife", target: "es2022",
    charset: "ascii", legalComments: "none", metafile: true, absWorkingDir: place,
  });
  return Object.keys(metafile.inputs);
}

/// Name, version and licence text of each package that has a file in the bundle.
function licences(inputs) {
  const names = new Set(inputs.map((path) => path.match(/node_modules\/((?:@[^/]+\/)?[^/]+)/)?.[1]).filter(Boolean));
  return [...names].sort().map((name) => {
    const folder = join(place, "node_modules", name);
    const { version, license } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
    const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
    const text = file ? readFileSync(join(folder, file), "utf8").trim() : license;
    return `${name} ${version}, ${license}\n\n${text}\n`;
  }).join("\n");
}

function write(script, style, text) {
  writeFileSync(join(output, "page.js"), script);
  writeFileSync(join(output, "page.css"), style);
  writeFileSync(join(output, "licences.txt"), text);
}

/// The style alone: what stands in the page without a script.
function plainStyle() {
  return readFileSync(join(sources, "src", "page.css"), "utf8").replace(/^@import.*$/m, "");
}

mkdirSync(dirname(place), { recursive: true });
try {
  install();
  const inputs = await bundle();
  write(readFileSync(join(place, "main.js"), "utf8"), readFileSync(join(place, "page.css"), "utf8"), licences(inputs));
} catch (error) {
  if (wanted === "enabled") throw error;
  const reason = String(error.stderr ?? error.message).trim().split("\n").slice(0, 3).join(" ");
  console.error(`report: pages are written without their script: ${reason}`);
  write("", plainStyle(), "");
}
