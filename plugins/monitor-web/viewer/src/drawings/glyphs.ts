import { CanvasTexture, LinearFilter } from "three";

/// Position and size of a glyph in the atlas.
export interface Glyph {
  /// Column and row of the cell.
  column: number;
  row: number;
  /// Width of the glyph as a fraction of the cell.
  advance: number;
}

export const kCells = 16;        // in a row, and rows
const kCell = 64;                // [px]
const kFont = `600 ${Math.round(kCell * 0.62)}px system-ui, "DejaVu Sans", sans-serif`;
const kUnknown = 0xfffd;

/// A texture atlas of glyphs, white with a black outline. Glyphs are added on first use; when it is full, new ones are
/// shown as question marks.
export class Glyphs {
  readonly texture: CanvasTexture;
  private readonly context: CanvasRenderingContext2D;
  private readonly glyphs = new Map<number, Glyph>();

  constructor() {
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = kCells * kCell;
    this.context = canvas.getContext("2d")!;
    this.context.font = kFont;
    this.context.textBaseline = "middle";
    this.context.lineJoin = "round";
    this.context.lineWidth = kCell * 0.14;
    this.texture = new CanvasTexture(canvas);
    this.texture.generateMipmaps = false;
    this.texture.minFilter = LinearFilter;
    this.draw(kUnknown, "?");
  }

  /// The glyph for this code point.
  of(code: number): Glyph {
    const known = this.glyphs.get(code);
    if (known) return known;
    if (this.glyphs.size >= kCells * kCells || code < 32) return this.glyphs.get(kUnknown)!;
    return this.draw(code, String.fromCodePoint(code));
  }

  dispose(): void {
    this.texture.dispose();
  }

  private draw(code: number, text: string): Glyph {
    const n = this.glyphs.size;
    const width = Math.min(this.context.measureText(text).width, kCell * 0.86);
    const glyph = { column: n % kCells, row: Math.floor(n / kCells), advance: width / kCell };
    const x = glyph.column * kCell + (kCell - width) / 2;
    const y = (glyph.row + 0.5) * kCell;
    this.context.strokeStyle = "#000";
    this.context.strokeText(text, x, y, kCell * 0.86);
    this.context.fillStyle = "#fff";
    this.context.fillText(text, x, y, kCell * 0.86);
    this.texture.needsUpdate = true;
    this.glyphs.set(code, glyph);
    return glyph;
  }
}
