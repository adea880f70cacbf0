/// Paths in the host's tree: "/usr/scene/Transform[2]". Siblings of equal names have an index, from the second one on.

export function joinPath(above: string, name: string): string {
  return above === "/" ? `/${name}` : `${above}/${name}`;
}

/// The parent; null for the root.
export function parentPath(path: string): string | null {
  if (path === "/") return null;
  const cut = path.lastIndexOf("/");
  return cut <= 0 ? "/" : path.slice(0, cut);
}

/// All ancestors, the root first.
export function pathsAbove(path: string): string[] {
  const out: string[] = [];
  for (let up = parentPath(path); up !== null; up = parentPath(up)) out.unshift(up);
  return out;
}

export function lastName(path: string): string {
  return path === "/" ? "/" : path.slice(path.lastIndexOf("/") + 1);
}

/// True for the node itself and its descendants.
export function isWithin(path: string, above: string): boolean {
  return path === above || above === "/" || path.startsWith(`${above}/`);
}

/// The paths of siblings with these names, in order.
export function childPaths(above: string, names: readonly string[]): string[] {
  const seen = new Map<string, number>();
  return names.map((name) => {
    const count = (seen.get(name) ?? 0) + 1;
    seen.set(name, count);
    return joinPath(above, count > 1 ? `${name}[${count}]` : name);
  });
}
