// Recordings of sparkhost --record, read by other people's programs: the packages @mcap/core and @mcap/support.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { promisify } from "node:util";
import { build, viewerPackage } from "./support/places.mjs";

const { McapStreamReader, McapIndexedReader } = viewerPackage("@mcap/core");
const { loadDecompressHandlers } = viewerPackage("@mcap/support");
const schemas = viewerPackage("@foxglove/schemas/jsonschema");

const folder = mkdtempSync(join(tmpdir(), "spark-recording-"));
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));
const seconds = 12, token = "0123456789abcdef";
let bytes;

/** The bytes of a recording of boxes that fall. */
async function recording() {
  const file = join(folder, "boxes.mcap");
  await promisify(execFile)(join(build, "bin", "sparkhost"), ["--config", "boxes.lua", "--seed", "7", "--rate", "max", "--duration", String(seconds), "--web-port", "0", "--record", file, "--log-level", "error", "--set", `webToken=${token}`]);
  return new Uint8Array(readFileSync(file));
}

/** All records, read from the front with every check; those of chunks as well. */
function stream(data, decompressHandlers) {
  const reader = new McapStreamReader({ validateCrcs: true, decompressHandlers });
  reader.append(data);
  const records = [];
  for (let record; (record = reader.nextRecord()); ) records.push(record);
  return { records, done: reader.done() };
}

const readable = (data) => ({ size: async () => BigInt(data.length), read: async (offset, length) => data.subarray(Number(offset), Number(offset) + Number(length)) });

async function messages(reader, options) {
  const out = [];
  for await (const message of reader.readMessages(options)) out.push(message);
  return out;
}

test("a recording is strictly valid, and says what it holds", async () => {
  bytes ??= await recording();
  const decompressHandlers = await loadDecompressHandlers();
  const { records, done } = stream(bytes, decompressHandlers);
  assert.ok(done, "the reader wants more");
  const of = (type) => records.filter((r) => r.type === type);
  const own = of("Channel").filter((c) => c.topic.startsWith("/spark/")).map((c) => c.id);
  assert.equal(of("Message").filter((m) => own.includes(m.channelId)).length, 50 * seconds + 5 * seconds + 3, "inputs of each cycle, hashes of every tenth, states at 0, 10 and 12 s");
  assert.ok(of("Channel").some((c) => c.topic === "/spark/hashes" && c.messageEncoding === "json"));
  assert.ok(of("Attachment").some((a) => a.name === "script:boxes.lua" && new TextDecoder().decode(a.data).includes("physics(")));
  assert.equal(of("Metadata")[0].metadata.get("seed"), "7");
  assert.equal(of("Footer").length, 1);
});

test("a recording is read by its index: all of it, one channel, a part of the time, backwards", async () => {
  bytes ??= await recording();
  const reader = await McapIndexedReader.Initialize({ readable: readable(bytes), decompressHandlers: await loadDecompressHandlers() });
  const all = await messages(reader);
  assert.equal(BigInt(all.length), reader.statistics.messageCount);
  assert.ok(reader.chunkIndexes.every((c) => c.messageEndTime - c.messageStartTime <= 1_000_000_000n), "a chunk is longer than a second");
  const hashes = await messages(reader, { topics: ["/spark/hashes"] });
  assert.deepEqual(hashes.map((m) => JSON.parse(new TextDecoder().decode(m.data)).cycle), [...Array(5 * seconds).keys()].map((i) => 10 * i + 10));
  const part = await messages(reader, { topics: ["/spark/hashes"], startTime: 3_000_000_000n, endTime: 4_000_000_000n });
  assert.equal(part.length, 6);
  const back = await messages(reader, { topics: ["/spark/hashes"], reverse: true });
  assert.deepEqual(back.map((m) => m.sequence), hashes.map((m) => m.sequence).reverse());
  const attachments = [];
  for await (const attachment of reader.readAttachments()) attachments.push(attachment.name);
  assert.ok(attachments.includes("script:house.lua"));
  for await (const metadata of reader.readMetadata()) assert.equal(metadata.name, "spark");
});

/** What is wrong with a value by a JSON schema, as far as those of Foxglove go; "" if nothing is. */
function wrong(value, schema, where = "it") {
  if (schema.oneOf) return schema.oneOf.some((one) => one.const === value) ? "" : `${where} is ${value}`;
  if (schema.type === "object") {
    if (typeof value !== "object" || value === null) return `${where} is no object`;
    for (const key of schema.required ?? []) if (!(key in value)) return `${where} lacks ${key}`;
    for (const [key, part] of Object.entries(value)) {
      if (!schema.properties?.[key]) return `${where} has ${key}, which the schema has not`;
      const found = wrong(part, schema.properties[key], `${where}.${key}`);
      if (found) return found;
    }
    return "";
  }
  if (schema.type === "array") return Array.isArray(value) ? value.map((v, i) => wrong(v, schema.items, `${where}[${i}]`)).find((text) => text) ?? "" : `${where} is no array`;
  if (schema.type === "integer") return Number.isInteger(value) && value >= (schema.minimum ?? -Infinity) && value <= (schema.maximum ?? Infinity) ? "" : `${where} is ${value}`;
  if (schema.type === "number") return typeof value === "number" ? "" : `${where} is no number`;
  return typeof value === schema.type ? "" : `${where} is no ${schema.type}`;
}

test("channels with a schema of Foxglove have messages of that schema, and the referee's token is in none", async () => {
  bytes ??= await recording();
  const reader = await McapIndexedReader.Initialize({ readable: readable(bytes), decompressHandlers: await loadDecompressHandlers() });
  let checked = 0;
  for (const channel of reader.channelsById.values()) {
    const schema = reader.schemasById.get(channel.schemaId);
    if (!schema?.name.startsWith("foxglove.")) continue;
    const theirs = schemas[schema.name.slice("foxglove.".length)];
    assert.ok(theirs, `there is no schema ${schema.name}`);
    assert.equal(JSON.parse(new TextDecoder().decode(schema.data)).title, schema.name);
    for (const message of await messages(reader, { topics: [channel.topic] })) {
      assert.equal(wrong(JSON.parse(new TextDecoder().decode(message.data)), theirs), "");
      checked++;
    }
  }
  assert.ok(checked > 0, "there is no message with a schema of Foxglove");
  // The log has the page's address, which ended with the token, and the metadata the command line. (What the inputs have is coded.)
  const texts = (await messages(reader)).map((message) => new TextDecoder().decode(message.data)).join("\n");
  assert.ok(texts.includes("http://127.0.0.1:"), "the address of the page is in no message");
  assert.ok(!texts.includes(token), "the token is in a message");
  for await (const metadata of reader.readMetadata()) {
    const values = [...metadata.metadata.values()].join();
    assert.ok(values.includes("webToken"), "the command line is not in the metadata");
    assert.ok(!values.includes(token), "the token is in the metadata");
  }
});

test("a recording that was cut off is read up to its last whole chunk", async () => {
  bytes ??= await recording();
  const decompressHandlers = await loadDecompressHandlers();
  const { records, done } = stream(bytes.subarray(0, Math.floor(bytes.length / 2)), decompressHandlers);
  assert.ok(!done);
  assert.ok(records.filter((r) => r.type === "Message").length > 100);
});
