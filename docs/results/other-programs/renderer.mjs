// Draws documents with Khronos' sample renderer in a headless Chromium.
//
//   npm install @khronosgroup/gltf-viewer@1.1.0 puppeteer-core
//   node renderer.mjs FOLDER LIST.json OUT
//
// FOLDER holds what scenes.py wrote; LIST.json is the list of scenes or files in it. Each has a camera of its own.
import fs from "node:fs";
import http from "node:http";
import path from "node:path";
import puppeteer from "puppeteer-core";

const [folder, list, out] = process.argv.slice(2);
const library = path.resolve("node_modules/@khronosgroup/gltf-viewer/dist");
const page = `<!doctype html><body style="margin:0"><canvas id="canvas" width="640" height="360"></canvas>
<script src="/library/libs/libktx.js"></script>
<script>window.DracoDecoderModule = async () => ({});</script>
<script type="module">
import { GltfView, GltfState } from "/library/gltf-viewer.module.js";
const canvas = document.getElementById("canvas");
const view = new GltfView(canvas.getContext("webgl2", { alpha: false, antialias: true, preserveDrawingBuffer: true }));
const loader = view.createResourceLoader(undefined, undefined, "/library/libs/");
const lights = {};
window.draw = async (file, light) => {
  const state = view.createState();
  state.gltf = await loader.loadGltf(file);
  lights[light] ??= await loader.loadEnvironment(light, { lut_sheen_E_file: "/sheen.png" });
  state.environment = lights[light];
  Object.assign(state.renderingParameters, { toneMap: GltfState.ToneMaps.NONE, blurEnvironmentMap: false });
  state.sceneIndex = state.gltf.scene ?? 0;
  state.cameraIndex = 0;
  state.cameraNodeIndex = 0;
  for (let k = 0; k < 3; k++) {
    view.renderFrame(state, canvas.width, canvas.height);
    await new Promise((done) => setTimeout(done, 30));
  }
  return canvas.toDataURL("image/png");
};
window.ready = true;
</script>`;

const types = { ".js": "text/javascript", ".wasm": "application/wasm", ".png": "image/png" };
const server = http.createServer((request, response) => {
  const name = decodeURIComponent(request.url);
  if (name === "/") return response.writeHead(200, { "content-type": "text/html" }).end(page);
  const file = name.startsWith("/library/") ? path.join(library, name.slice(9)) : path.join(folder, name);
  if (!fs.existsSync(file)) return response.writeHead(404).end();
  const type = types[path.extname(file)] ?? "application/octet-stream";
  response.writeHead(200, { "content-type": type }).end(fs.readFileSync(file));
});
server.listen(0);
const browser = await puppeteer.launch({
  executablePath: "/usr/bin/chromium",
  protocolTimeout: 600000,
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
});
const tab = await browser.newPage();
await tab.goto(`http://localhost:${server.address().port}/`);
await tab.waitForFunction("window.ready");
fs.mkdirSync(out, { recursive: true });
for (const scene of JSON.parse(fs.readFileSync(list))) {
  const data = await tab.evaluate((file, light) => window.draw(file, light), `/${scene.file}`, `/${scene.light}.hdr`);
  fs.writeFileSync(path.join(out, `${scene.name}.png`), Buffer.from(data.split(",")[1], "base64"));
}
await browser.close();
server.close();
