import { describe, expect, it } from "vitest";
import type { TreeAnswer } from "../../src/inspect/inspectable";
import { childPaths, isWithin, parentPath, pathsAbove } from "../../src/inspect/paths";
import { TreeModel } from "../../src/inspect/tree_model";

const leaf = (name: string, kind = "Leaf"): TreeAnswer => ({ name, class: kind, doc: "" });
const inner = (name: string, children: TreeAnswer[], kind = "Node"): TreeAnswer => ({ ...leaf(name, kind), children });
const closed = (name: string, more: number, kind = "Node"): TreeAnswer => ({ ...leaf(name, kind), children: [], more });
const paths = (model: TreeModel) => model.rows.map((r) => r.path);

function house(): TreeModel {
  const model = new TreeModel();
  model.fill("/", inner("", [closed("sys", 2), closed("usr", 1)]));
  return model;
}

describe("paths", () => {
  it("count brothers of one name from the second one on", () => {
    expect(childPaths("/usr", ["a", "b", "a", "a"])).toEqual(["/usr/a", "/usr/b", "/usr/a[2]", "/usr/a[3]"]);
    expect(childPaths("/", ["sys"])).toEqual(["/sys"]);
  });

  it("know what is above and within", () => {
    expect(pathsAbove("/usr/scene/Ball")).toEqual(["/", "/usr", "/usr/scene"]);
    expect(parentPath("/usr")).toBe("/");
    expect(parentPath("/")).toBeNull();
    expect(isWithin("/usr/scene", "/usr")).toBe(true);
    expect(isWithin("/usr2", "/usr")).toBe(false);
  });
});

describe("a tree", () => {
  it("asks for the children of what is opened, and shows them when they come", () => {
    const model = house();
    expect(model.wanted()).toBeNull();
    model.setOpen("/usr", true);
    expect(model.wanted()).toBe("/usr");
    model.fill("/usr", inner("usr", [leaf("scene")]));
    expect(model.wanted()).toBeNull();
    expect(paths(model)).toEqual(["/", "/sys", "/usr", "/usr/scene"]);
  });

  it("does not ask again for what the host would not tell", () => {
    const model = house();
    model.setOpen("/usr", true);
    model.failed("/usr");
    expect(model.wanted()).toBeNull();
  });

  it("keeps open what was open when robots come and go", () => {
    const model = house();
    model.setOpen("/usr", true);
    model.fill("/usr", inner("usr", [closed("Robot", 1), closed("Ball", 1)]));
    model.setOpen("/usr/Ball", true);
    model.fill("/usr/Ball", inner("Ball", [leaf("physics")]));
    expect(model.loaded()).toEqual(["/", "/usr", "/usr/Ball"]);
    model.fill("/usr", inner("usr", [closed("Ball", 1), closed("Other", 3)]));
    expect(paths(model)).toEqual(["/", "/sys", "/usr", "/usr/Ball", "/usr/Ball/physics", "/usr/Other"]);
    expect(model.node("/usr/Robot")).toBeUndefined();
  });

  it("forgets what is below a node that became another class", () => {
    const model = house();
    model.fill("/usr", inner("usr", [inner("x", [leaf("y")], "A")]));
    expect(model.node("/usr/x/y")).toBeDefined();
    model.fill("/usr", inner("usr", [closed("x", 1, "B")]));
    expect(model.node("/usr/x/y")).toBeUndefined();
    expect(model.node("/usr/x")!.children).toBeNull();
  });

  it("tells step by step what must be known to reveal a path", () => {
    const model = house();
    expect(model.reveal("/usr/scene/Ball")).toBe("/usr");
    model.fill("/usr", inner("usr", [closed("scene", 1)]));
    expect(model.reveal("/usr/scene/Ball")).toBe("/usr/scene");
    model.fill("/usr/scene", inner("scene", [leaf("Ball")]));
    expect(model.reveal("/usr/scene/Ball")).toBeNull();
    expect(paths(model)).toContain("/usr/scene/Ball");
    expect(model.reveal("/usr/nothing/Ball")).toBeNull();
  });

  it("moves by keys as trees do", () => {
    const model = house();
    model.key("ArrowDown");
    expect(model.focus).toBe("/sys");
    model.key("End");
    expect(model.focus).toBe("/usr");
    expect(model.key("ArrowRight")).toBe(true);
    expect(model.node("/usr")!.open).toBe(true);
    model.fill("/usr", inner("usr", [leaf("scene")]));
    model.key("ArrowRight");
    expect(model.focus).toBe("/usr/scene");
    model.key("ArrowLeft");
    expect(model.focus).toBe("/usr");
    model.key("ArrowLeft");
    expect(model.node("/usr")!.open).toBe(false);
    model.key("ArrowLeft");
    expect(model.focus).toBe("/");
    expect(model.key("x")).toBe(false);
    model.key("ArrowRight");
    expect(model.focus).toBe("/sys");
    model.key("*");
    expect(model.node("/sys")!.open && model.node("/usr")!.open).toBe(true);
  });

  it("shows with a filter what matches, what is above it, and looks for more", () => {
    const model = house();
    model.filter = "ball rigid";
    expect(model.wanted()).toBe("/sys");
    model.fill("/sys", inner("sys", [leaf("server")]));
    expect(model.wanted()).toBe("/usr");
    model.fill("/usr", inner("usr", [leaf("ballBody", "RigidBody"), leaf("Ball", "Transform")]));
    expect(model.wanted()).toBeNull();
    expect(paths(model)).toEqual(["/", "/usr", "/usr/ballBody"]);
    model.filter = "";
    expect(paths(model)).toEqual(["/", "/sys", "/usr"]);
  });

  it("stops looking for more at its bound", () => {
    const model = new TreeModel(3);
    model.fill("/", inner("", [closed("sys", 2), closed("usr", 1)]));
    model.filter = "x";
    expect(model.wanted()).toBeNull();
  });

  it("takes the focus from rows that go", () => {
    const model = house();
    model.focus = "/usr";
    model.fill("/", inner("", [closed("sys", 2)]));
    expect(model.focus).toBe("/");
  });
});
