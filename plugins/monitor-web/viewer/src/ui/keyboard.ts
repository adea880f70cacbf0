/// Key bindings: one table for the handler and the help.

/// The part of KeyboardEvent that determines a combination.
export interface Stroke {
  key: string;
  code: string;
  shiftKey: boolean;
  ctrlKey: boolean;
  altKey: boolean;
  metaKey: boolean;
}

const kNamed: Record<string, string> = { " ": "space", arrowleft: "left", arrowright: "right", arrowup: "up", arrowdown: "down", escape: "esc" };

/// "x", "shift+3", "?", "shift+left": digits by their position on the keyboard, symbols by the character that they
/// produce.
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

/// The key caps shown in the help: "shift+left" is Shift and ←.
export function capsOf(combo: string): string[] {
  if (combo === "+") return ["+"];
  return combo.split("+").map((part) => kPrinted[part] ?? part.toUpperCase());
}

export interface Binding {
  combo: string;
  title: string;
  group: string;
  /// Undefined: the key is only listed in the help; another component handles it.
  run?: () => void;
  /// The key is active only if this returns true; undefined: always.
  when?: () => boolean;
  /// Not listed in the help, because another line covers it.
  hidden?: boolean;
}

/// Keys that a focused control handles itself.
export function belongsToControl(combo: string, target: Element | null): boolean {
  if (!target || combo === "esc") return false;
  if (target.closest("input:not([type=checkbox]):not([type=radio]), textarea, select, [contenteditable=true]")) return true;
  const pressed = combo === "space" || combo === "enter";
  return pressed && target.closest("button, a, summary, input, [role=option], [role=treeitem], [role=tab]") !== null;
}

/// The camera, which moves while a key is held down.
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

  /// The bindings for the help, in groups, in the order in which they were added.
  groups(): Map<string, Binding[]> {
    const groups = new Map<string, Binding[]>();
    for (const binding of this.bindings) {
      if (binding.hidden) continue;
      groups.set(binding.group, [...(groups.get(binding.group) ?? []), binding]);
    }
    return groups;
  }

  /// Listens for the lifetime of the page. Keys without an action are passed to `camera`.
  listen(target: Window, camera: CameraKeys): void {
    target.addEventListener("keydown", (event) => {
      const combo = comboOf(event);
      // a dialog over the page gets all keys
      if (document.querySelector("dialog[open]")) return;
      if (event.defaultPrevented || event.isComposing || belongsToControl(combo, event.target as Element | null)) return;
      if (this.run(combo) || (isPlain(event) && camera.key(event))) event.preventDefault();
    });
    target.addEventListener("keyup", (event) => void camera.key(event));
    target.addEventListener("blur", () => camera.release());
  }
}
