/// Formats property values and extracts the numbers in them.

/// A number in a value that can be plotted, and its display name.
export interface Component {
  /// Indices into nested lists; empty: the value itself.
  at: number[];
  label: string;
}

const kAxes = ["x", "y", "z", "w"];
const kMaxComponents = 24;

/// A short text whose width stays about the same while the value changes.
export function formatNumber(v: number): string {
  if (!Number.isFinite(v)) return Number.isNaN(v) ? "nan" : v > 0 ? "∞" : "−∞";
  const size = Math.abs(v);
  if (Number.isInteger(v) && size < 1e9) return sign(v) + size;
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) return sign(v) + size.toExponential(3).replace("e-", "e−").replace("e+", "e");
  return sign(v) + size.toFixed(size >= 1000 ? 1 : size >= 10 ? 3 : 4);
}

function sign(v: number): string {
  return v < 0 ? "−" : "";
}

/// Lines of text: one for most values, one per row for matrices and lists of named values.
export function formatValue(value: unknown, type = ""): string[] {
  if (type === "matrix" && isNumbers(value) && value.length === 16) return matrixRows(value);
  if (isPairs(value)) return value.map(([name, v]) => `${name}  ${formatValue(v)[0]}`);
  if (Array.isArray(value)) return value.length === 0 ? ["none"] : [value.map((v) => formatNested(v)).join("  ")];
  return [formatScalar(value)];
}

function matrixRows(m: number[]): string[] {
  const width = Math.max(...m.map((v) => formatNumber(v).length));
  return [0, 1, 2, 3].map((row) => [0, 1, 2, 3].map((column) => formatNumber(m[row + 4 * column]!).padStart(width)).join("  "));
}

function formatNested(value: unknown): string {
  return Array.isArray(value) ? `(${value.map((v) => formatNested(v)).join(" ")})` : formatScalar(value);
}

function formatScalar(value: unknown): string {
  if (typeof value === "number") return formatNumber(value);
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (value === null || value === undefined) return "none";
  return value === "" ? "“”" : String(value);
}

function isNumbers(value: unknown): value is number[] {
  return Array.isArray(value) && value.every((v) => typeof v === "number");
}

/// A list such as {{"physics", 0.4}, {"sense", 0.1}}.
function isPairs(value: unknown): value is [string, unknown][] {
  return Array.isArray(value) && value.length > 0 &&
    value.every((v) => Array.isArray(v) && v.length === 2 && typeof v[0] === "string" && !Array.isArray(v[1]));
}

/// The numbers of a value, in order; booleans count as 0 and 1. Empty if there are none.
export function componentsOf(value: unknown): Component[] {
  if (typeof value === "number" || typeof value === "boolean") return [{ at: [], label: "" }];
  if (isPairs(value)) {
    return value.flatMap(([name, v], i) => (typeof v === "number" ? [{ at: [i, 1], label: name }] : [])).slice(0, kMaxComponents);
  }
  if (!isNumbers(value) || value.length > kMaxComponents) return [];
  return value.map((_, i) => ({ at: [i], label: value.length <= 4 ? kAxes[i]! : String(i + 1) }));
}

/// NaN if the number no longer exists.
export function numberAt(value: unknown, at: readonly number[]): number {
  let v = value;
  for (const step of at) v = Array.isArray(v) ? v[step] : undefined;
  return typeof v === "number" ? v : typeof v === "boolean" ? Number(v) : NaN;
}

/// The value as typed by a user: true, 3, {1, 2}, words.
export function editText(value: unknown): string {
  if (Array.isArray(value)) return `{${value.map(editText).join(", ")}}`;
  return value === null || value === undefined ? "" : String(value);
}
