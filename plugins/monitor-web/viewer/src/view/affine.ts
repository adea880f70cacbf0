/// Matrices as 16 numbers, column by column, whose last row is 0 0 0 1. Many are stored consecutively in one array, so
/// all functions take offsets.

export type Numbers = Float32Array | Float64Array | number[];

/// out = a * b; out must not be a or b.
export function multiply(out: Numbers, o: number, a: Numbers, i: number, b: Numbers, j: number): void {
  const a0 = a[i]!, a1 = a[i + 1]!, a2 = a[i + 2]!, a4 = a[i + 4]!, a5 = a[i + 5]!, a6 = a[i + 6]!;
  const a8 = a[i + 8]!, a9 = a[i + 9]!, a10 = a[i + 10]!;
  for (let column = 0; column < 16; column += 4) {
    const x = b[j + column]!, y = b[j + column + 1]!, z = b[j + column + 2]!;
    out[o + column] = a0 * x + a4 * y + a8 * z;
    out[o + column + 1] = a1 * x + a5 * y + a9 * z;
    out[o + column + 2] = a2 * x + a6 * y + a10 * z;
    out[o + column + 3] = 0;
  }
  out[o + 12]! += a[i + 12]!;
  out[o + 13]! += a[i + 13]!;
  out[o + 14]! += a[i + 14]!;
  out[o + 15] = 1;
}

/// Writes a rotation (x, y, z, w) and a position as a matrix.
export function compose(out: Numbers, o: number, position: readonly number[], rotation: readonly number[]): void {
  const [x, y, z, w] = rotation as [number, number, number, number];
  out[o] = 1 - 2 * (y * y + z * z);
  out[o + 1] = 2 * (x * y + z * w);
  out[o + 2] = 2 * (x * z - y * w);
  out[o + 3] = 0;
  out[o + 4] = 2 * (x * y - z * w);
  out[o + 5] = 1 - 2 * (x * x + z * z);
  out[o + 6] = 2 * (y * z + x * w);
  out[o + 7] = 0;
  out[o + 8] = 2 * (x * z + y * w);
  out[o + 9] = 2 * (y * z - x * w);
  out[o + 10] = 1 - 2 * (x * x + y * y);
  out[o + 11] = 0;
  out[o + 12] = position[0]!;
  out[o + 13] = position[1]!;
  out[o + 14] = position[2]!;
  out[o + 15] = 1;
}

export function identity(out: Numbers, o: number): void {
  compose(out, o, [0, 0, 0], [0, 0, 0, 1]);
}

/// Transforms a world point into the frame of a matrix without scale.
export function toLocal(matrix: Numbers, o: number, point: readonly [number, number, number], out: [number, number, number]): void {
  rotateBack(matrix, o, [point[0] - matrix[o + 12]!, point[1] - matrix[o + 13]!, point[2] - matrix[o + 14]!], out);
}

/// The same for a direction.
export function rotateBack(matrix: Numbers, o: number, v: readonly [number, number, number], out: [number, number, number]): void {
  const [x, y, z] = v;
  for (let row = 0; row < 3; row++) out[row] = matrix[o + 4 * row]! * x + matrix[o + 4 * row + 1]! * y + matrix[o + 4 * row + 2]! * z;
}
