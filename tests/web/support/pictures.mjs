// Screenshots: stored as files, and as pixels for comparisons.
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { deflateSync, inflateSync } from "node:zlib";
import { screenshots } from "./places.mjs";

/** The pixels of a PNG in Chromium's format: 8 bits per channel, RGB or RGBA, not interlaced. */
export function decode(png) {
  const parts = [];
  let width, height, channels;
  for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at)) {
    const body = png.subarray(at + 8, at + 8 + png.readUInt32BE(at));
    const kind = png.toString("latin1", at + 4, at + 8);
    if (kind === "IHDR") {
      [width, height, channels] = [body.readUInt32BE(0), body.readUInt32BE(4), { 2: 3, 6: 4 }[body[9]]];
      if (body[8] !== 8 || !channels || body[12] !== 0) throw new Error("this kind of PNG is not read here");
    } else if (kind === "IDAT") {
      parts.push(body);
    }
  }
  return { width, height, channels, data: unfilter(inflateSync(Buffer.concat(parts)), width, height, channels) };
}

/** Reverses the filters of PNG: each byte is stored as the difference from a prediction by its neighbors. */
function unfilter(raw, width, height, channels) {
  const row = width * channels;
  const data = new Uint8Array(row * height);
  for (let y = 0; y < height; y++) {
    const filter = raw[y * (row + 1)];
    for (let x = 0; x < row; x++) {
      const left = x >= channels ? data[y * row + x - channels] : 0;
      const up = y > 0 ? data[(y - 1) * row + x] : 0;
      const corner = x >= channels && y > 0 ? data[(y - 1) * row + x - channels] : 0;
      data[y * row + x] = raw[y * (row + 1) + 1 + x] + guess(filter, left, up, corner);
    }
  }
  return data;
}

function guess(filter, left, up, corner) {
  if (filter === 4) {
    const [a, b, c] = [Math.abs(up - corner), Math.abs(left - corner), Math.abs(left + up - 2 * corner)];
    return a <= b && a <= c ? left : b <= c ? up : corner;
  }
  return [0, left, up, (left + up) >> 1][filter];
}

/** The number of colors, with 4 bits per channel. */
export function colors({ channels, data }) {
  const seen = new Set();
  for (let i = 0; i < data.length; i += channels) seen.add(((data[i] >> 4) << 8) | ((data[i + 1] >> 4) << 4) | (data[i + 2] >> 4));
  return seen.size;
}

/** The fraction of pixels, 0..1, that clearly differ; 1 if the sizes differ. */
export function difference(a, b) {
  if (a.width !== b.width || a.height !== b.height) return 1;
  let others = 0;
  for (let i = 0, j = 0; i < a.data.length; i += a.channels, j += b.channels)
    if ([0, 1, 2].some((k) => Math.abs(a.data[i + k] - b.data[j + k]) > 12)) others++;
  return others / (a.width * a.height);
}

/** Takes a picture of a page or an element of it and stores it as web-screenshots/NAME.png. */
export async function shoot(what, name) {
  const png = await what.screenshot();
  writeFileSync(join(screenshots, `${name}.png`), png);
  return decode(png);
}

/** Takes a picture for a page of the documentation: colors have 5 bits per channel, which takes a third of the bytes. Returns pixels and bytes. */
export async function shootForPage(what, name, folder = screenshots) {
  const pixels = decode(await what.screenshot());
  const data = pixels.data.map((value) => Math.min(255, (value + 4) & ~7));
  const png = encode({ ...pixels, data });
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, `${name}.png`), png);
  return { pixels, bytes: png.length };
}

/** Encodes a PNG with 8 bits per channel and unfiltered rows. */
export function encode({ width, height, channels, data }) {
  const row = width * channels;
  const raw = Buffer.alloc(height * (row + 1));
  for (let y = 0; y < height; y++) raw.set(data.subarray(y * row, (y + 1) * row), y * (row + 1) + 1);
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, channels === 4 ? 6 : 2], 8);
  const signature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10]);
  return Buffer.concat([signature, chunk("IHDR", head), chunk("IDAT", deflateSync(raw, { level: 9 })), chunk("IEND", Buffer.alloc(0))]);
}

function chunk(kind, body) {
  const out = Buffer.alloc(12 + body.length);
  out.writeUInt32BE(body.length, 0);
  out.write(kind, 4, "latin1");
  out.set(body, 8);
  out.writeUInt32BE(crc(out.subarray(4, 8 + body.length)), 8 + body.length);
  return out;
}

/** CRC-32 of PNG (ISO 3309). */
function crc(bytes) {
  let sum = 0xffffffff;
  for (const byte of bytes) {
    sum ^= byte;
    for (let bit = 0; bit < 8; bit++) sum = (sum >>> 1) ^ (sum & 1 ? 0xedb88320 : 0);
  }
  return ~sum >>> 0;
}
