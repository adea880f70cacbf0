// The built viewer as files, without a host.
import assert from "node:assert/strict";
import { test } from "node:test";
import { openPage } from "./support/browser.mjs";
import { viewer } from "./support/places.mjs";
import { serveFiles } from "./support/file_server.mjs";

test("the built page loads without an error", async (t) => {
  const page = await openPage(t, await serveFiles(t, viewer, { "favicon.ico": "" }));
  assert.equal(await page.title(), "Spark");
});
