// Prints the viewer's frames per second for a replay of 22 humanoids: flat mode, 1280 x 720, WebGL in software.
//
//     node tests/web/frame_rate.mjs [SECONDS]      # of measuring, 10 by default, on an idle machine
import { readFile } from "node:fs/promises";
import { cpus } from "node:os";
import { state, until } from "./support/app.mjs";
import { openPage } from "./support/browser.mjs";
import { serveFiles } from "./support/file_server.mjs";
import { humanoidMatch, recordMatch } from "./support/host.mjs";
import { viewer } from "./support/places.mjs";

const seconds = Number(process.argv[2] ?? 10);
const endings = [];
const owner = { after: (ending) => endings.unshift(ending) };

/** Counts the frames drawn in a period of the page's own time. */
function count(page) {
  return page.evaluate(
    (milliseconds) =>
      new Promise((done) => {
        const [begun, before] = [performance.now(), window.spark.state().frames];
        const look = () => {
          const passed = performance.now() - begun;
          if (passed < milliseconds) return requestAnimationFrame(look);
          done({ framesPerSecond: (1000 * (window.spark.state().frames - before)) / passed, seconds: passed / 1000 });
        };
        look();
      }),
    1000 * seconds,
  );
}

/** Quality and size of the drawn picture. */
function picture(page) {
  return page.evaluate(() => {
    const { canvas, quality } = window.spark.app.stage;
    return { quality, width: canvas.width, height: canvas.height };
  });
}

try {
  const match = await readFile(await recordMatch(owner, 2 * seconds + 20, ...humanoidMatch, "--seed", "7"));
  const page = await openPage(owner, `${await serveFiles(owner, viewer, { "match.log": match })}?file=match.log&quality=flat&view=broadcast&panel=none&at=5`);
  await until(page, "the match", (s) => s.source === "replay" && s.robots.length === 22 && s.playing);
  const { width } = await picture(page);
  await page.setViewportSize({ width: 2 * 1280 - width, height: 720 });  // makes room for the panels
  await page.evaluate(() => (window.spark.app.stage.adaptive = false));  // full resolution
  const { frames } = await state(page);
  await until(page, "that it runs smoothly", (s, minimum) => s.frames >= minimum, frames + 20);
  const measured = await count(page);
  console.log(JSON.stringify({ ...measured, ...(await picture(page)), robots: 22, cores: cpus().length }));
} finally {
  for (const ending of endings) await ending();
}
