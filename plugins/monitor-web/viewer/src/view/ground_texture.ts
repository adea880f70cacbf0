import { CanvasTexture, SRGBColorSpace } from "three";
import { fieldLines, stripes, type FieldSizes } from "./field_sizes";
import { css, type Surroundings } from "./palette";

/// Pixels of the longer edge.
const resolution = 2048;

/// Paints the ground for quality mode: grass with stripes, blades and lines, or a floor with a grid, between -x..x and
/// -y..y [m].
export function paintField(field: FieldSizes | null, x: number, y: number, around: Surroundings): CanvasTexture {
  const scale = resolution / Math.max(2 * x, 2 * y);
  const canvas = document.createElement("canvas");
  canvas.width = Math.round(2 * x * scale);
  canvas.height = Math.round(2 * y * scale);
  const paint = canvas.getContext("2d")!;
  paint.translate(canvas.width / 2, canvas.height / 2);
  paint.scale(scale, -scale);
  if (field) paintGrass(paint, field, y, around);
  else paintFloor(paint, x, y, around);
  paintNoise(paint, x, y, scale);
  if (field) paintLines(paint, field, around);
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.anisotropy = 4;
  return texture;
}

function paintGrass(paint: CanvasRenderingContext2D, field: FieldSizes, y: number, around: Surroundings): void {
  for (const { from, to, alternate } of stripes(field)) {
    paint.fillStyle = css(alternate ? around.grassAlternate : around.grass);
    paint.fillRect(from - 0.01, -y, to - from + 0.02, 2 * y);
  }
}

function paintFloor(paint: CanvasRenderingContext2D, x: number, y: number, around: Surroundings): void {
  paint.fillStyle = css(around.floor);
  paint.fillRect(-x, -y, 2 * x, 2 * y);
  paint.fillStyle = css(around.floorLine);
  for (let s = -Math.floor(x); s <= x; s++) paint.fillRect(s - 0.01, -y, 0.02, 2 * y);
  for (let s = -Math.floor(y); s <= y; s++) paint.fillRect(-x, s - 0.01, 2 * x, 0.02);
}

/// Small light and dark specks, the same on every page load.
function paintNoise(paint: CanvasRenderingContext2D, x: number, y: number, scale: number): void {
  const tile = document.createElement("canvas");
  tile.width = tile.height = 256;
  const brush = tile.getContext("2d")!, pixels = brush.createImageData(256, 256);
  let state = 12345;
  for (let k = 0; k < pixels.data.length; k += 4) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    const value = state >>> 24;
    pixels.data.fill(value < 128 ? 0 : 255, k, k + 3);
    pixels.data[k + 3] = Math.abs(value - 128) / 9;
  }
  brush.putImageData(pixels, 0, 0);
  paint.save();
  paint.scale(1 / scale, 1 / scale);
  paint.fillStyle = paint.createPattern(tile, "repeat")!;
  paint.fillRect(-x * scale, -y * scale, 2 * x * scale, 2 * y * scale);
  paint.restore();
}

function paintLines(paint: CanvasRenderingContext2D, field: FieldSizes, around: Surroundings): void {
  paint.strokeStyle = css(around.line);
  paint.lineWidth = field.lineWidth;
  paint.lineCap = "square";
  for (const [first, ...rest] of fieldLines(field)) {
    paint.beginPath();
    paint.moveTo(...first!);
    for (const point of rest) paint.lineTo(...point);
    paint.stroke();
  }
}
