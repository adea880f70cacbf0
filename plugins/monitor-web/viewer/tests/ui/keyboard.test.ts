import { describe, expect, it } from "vitest";
import { belongsToControl, capsOf, comboOf, Keyboard, type Stroke } from "../../src/ui/keyboard";

const stroke = (key: string, code: string, held: Partial<Stroke> = {}): Stroke => ({ key, code, shiftKey: false, ctrlKey: false, altKey: false, metaKey: false, ...held });

/// A minimal element that matches these words of a selector.
const control = (...names: string[]) => ({ closest: (selector: string) => (names.some((n) => selector.split(", ").some((s) => s.startsWith(n))) ? {} : null) }) as unknown as Element;

describe("key combinations", () => {
  it("have the names of their keys", () => {
    expect(comboOf(stroke(" ", "Space"))).toBe("space");
    expect(comboOf(stroke("ArrowLeft", "ArrowLeft", { shiftKey: true }))).toBe("shift+left");
    expect(comboOf(stroke("Escape", "Escape"))).toBe("esc");
    expect(comboOf(stroke("B", "KeyB", { shiftKey: true }))).toBe("shift+b");
    expect(comboOf(stroke("o", "KeyO", { metaKey: true }))).toBe("ctrl+o");
  });
  it("use the physical key for digits, independently of shift", () => {
    expect(comboOf(stroke("§", "Digit3", { shiftKey: true }))).toBe("shift+3");
  });
  it("use the printed character for symbols, independently of modifiers", () => {
    expect(comboOf(stroke("?", "Minus", { shiftKey: true }))).toBe("?");
    expect(comboOf(stroke("[", "BracketLeft"))).toBe("[");
  });
  it("are shown as key caps", () => {
    expect(capsOf("shift+left")).toEqual(["Shift", "←"]);
    expect(capsOf("+")).toEqual(["+"]);
    expect(capsOf("x")).toEqual(["X"]);
  });
});

describe("the keyboard", () => {
  it("runs a binding only when its condition is met", () => {
    const keyboard = new Keyboard();
    const runs: string[] = [];
    let replay = false;
    keyboard.bind({ combo: "x", title: "X", group: "A", run: () => runs.push("x") }, { combo: "space", title: "Play", group: "A", run: () => runs.push("play"), when: () => replay });
    expect([keyboard.run("x"), keyboard.run("space"), keyboard.run("y")]).toEqual([true, false, false]);
    replay = true;
    expect(keyboard.run("space")).toBe(true);
    expect(runs).toEqual(["x", "play"]);
  });
  it("refuses a second binding of a key", () => {
    const keyboard = new Keyboard();
    keyboard.bind({ combo: "x", title: "contacts", group: "A", run: () => undefined });
    expect(() => keyboard.bind({ combo: "x", title: "other", group: "A", run: () => undefined })).toThrow("the key x is taken: contacts");
  });
  it("groups the help without hidden bindings, and ignores bindings without an action", () => {
    const keyboard = new Keyboard();
    keyboard.bind({ combo: "w a s d", title: "Slide", group: "Camera" }, { combo: "1", title: "", group: "Robots", hidden: true, run: () => undefined }, { combo: "t", title: "Top", group: "Camera", run: () => undefined });
    expect([...keyboard.groups()].map(([name, bindings]) => [name, bindings.map((b) => b.title)])).toEqual([["Camera", ["Slide", "Top"]]]);
    expect(keyboard.run("w a s d")).toBe(false);
  });
});

describe("keys that a control uses itself", () => {
  it("are all keys in input fields except escape", () => {
    expect(belongsToControl("x", control("input:not"))).toBe(true);
    expect(belongsToControl("esc", control("input:not"))).toBe(false);
  });
  it("are space and enter on buttons", () => {
    expect([belongsToControl("space", control("button")), belongsToControl("x", control("button"))]).toEqual([true, false]);
    expect(belongsToControl("space", control())).toBe(false);
  });
});
