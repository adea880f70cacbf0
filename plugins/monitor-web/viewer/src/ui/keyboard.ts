/// Keys and what they do: one table for the handler and the help.

/// As much of a KeyboardEvent as a combination needs.
export interface Stroke {
  key: string;
  code: string;
  shiftKey: boolean;
  ctrlKey: boolean;
  altKey: boolean;
  metaKey: boolean;
}

const kNamed: Record<string, string> = { " ": "space", arrowleft: "left", arrowright: "right", arrowup: "up", arrowdown: "down", escape: "esc" };

/// "x", "shift+3", "?", "shift+left": digits by their place on the keyboard, signs by what they print.
export function comboOf(stroke: Stroke): string {
  const digit = /^Digit(\d)$/.exec(stroke.code)?.[1];
  const lower = stroke.key.toLowerCase();
  const name = digit ?? kNamed[lower] ?? lower;
  // "?" needs shift on some keyboards and not on others
  const sign = name.length === 1 && !/[a-z0-9]/.test(name);
  return [stroke.ctrlKey || stroke.metaKey ? "ctrl+" : "", stroke.altKey ? "alt+" : "", stroke.shiftKey && !sign ? "shift+" : "", name].join("");
}

const kPrinted: Record<string, string> = {
  left: "←",
  right: "→",
  up: "↑",
  down: "↓",
  space: "Space",
  esc: "Esc",
  backspace: "⌫",
  home: "Home",
  end: "End",
  pageup: "Page ↑",
  pagedown: "Page ↓",
  shift: "Shift",
  ctrl: "Ctrl",
  alt: "Alt",
};

/// The caps to print in the help: "shift+left" is Shift and ←.
export function capsOf(combo: string): string[] {
  if (combo === "+") return ["+"];
  return combo.split("+").map((part) => kPrinted[part] ?? part.toUpperCase());
}

export interface Binding {
  combo: string;
  title: string;
  group: string;
  /// Undefined: the key is listed in the help only; another part handles it.
  run?: () => void;
  /// Only then; always when left out.
  when?: () => boolean;
  /// Not in the help: another line tells of it.
  hidden?: boolean;
}

/// Keys that a focused control needs itself.
export function belongsToControl(combo: string, target: Element | null): boolean {
  if (!target || combo === "esc") return false;
  if (target.closest("input:not([type=checkbox]):not([type=radio]), textarea, select, [contenteditable=true]")) return true;
  const pressed = combo === "space" || combo === "enter";
  return pressed && target.closest("button, a, summary, input, [role=option], [role=treeitem], [role=tab]") !== null;
}

/// What moves while a key is held down.
export interface CameraKeys {
  key(event: KeyboardEvent): boolean;
  release(): void;
}

const isPlain = (stroke: Stroke) => !stroke.ctrlKey && !stroke.altKey && !stroke.metaKey;

export class Keyboard {
  private readonly bindings: Binding[] = [];

  bind(...bindings: Binding[]): void {
    for (const binding of bindings) {
      const taken = this.bindings.find((b) => b.combo === binding.combo && !b.when && !binding.when);
      if (taken) throw new Error(`the key ${binding.combo} is taken: ${taken.title}`);
      this.bindings.push(binding);
    }
  }

  /// Runs the action of the combination; false if it has none now.
  run(combo: string): boolean {
    const binding = this.bindings.find((b) => b.run && b.combo === combo && (!b.when || b.when()));
    binding?.run?.();
    return binding !== undefined;
  }

  /// For the help: groups in the order in which they were bound.
  groups(): Map<string, Binding[]> {
    const groups = new Map<string, Binding[]>();
    for (const binding of this.bindings) {
      if (binding.hidden) continue;
      groups.set(binding.group, [...(groups.get(binding.group) ?? []), binding]);
    }
    return groups;
  }

  /// Listens for as long as the page lives. Keys without an action go to `camera`.
  listen(target: Window, camera: CameraKeys): void {
    target.addEventListener("keydown", (event) => {
      const combo = comboOf(event);
      // a window over the page has the keyboard to itself
      if (document.querySelector("dialog[open]")) return;
      if (event.defaultPrevented || event.isComposing || belongsToControl(combo, event.target as Element | null)) return;
      if (this.run(combo) || (isPlain(event) && camera.key(event))) event.preventDefault();
    });
    target.addEventListener("keyup", (event) => void camera.key(event));
    target.addEventListener("blur", () => camera.release());
  }
}
