import { describe, expect, it } from "vitest";
import type { TreeAnswer } from "../../src/inspect/inspectable";
import { childPaths, isWithin, parentPath, pathsAbove } from "../../src/inspect/paths";
import { TreeModel } from "../../src/inspect/tree_model";

const leaf = (name: string, kind = "Leaf"): TreeAnswer => ({ name, class: kind, doc: "" });
const inner = (name: string, children: TreeAnswer[], kind = "Node"): TreeAnswer => ({ ...leaf(name, kind), children });
const closed = (name: string, more: number, kind = "Node"): TreeAnswer => ({ ...leaf(name, kind), children: [], more });
const paths = (model: TreeModel) => model.rows.map((r) => r.path);

function sampleTree(): TreeModel {
  const model = new TreeModel();
  model.fill("/", inner("", [closed("sys", 2), closed("usr", 1)]));
  return model;
}

describe("paths", () => {
  it("number siblings of one name from the second one on", () => {
    expect(childPaths("/usr", ["a", "b", "a", "a"])).toEqual(["/usr/a", "/usr/b", "/usr/a[2]", "/usr/a[3]"]);
    expect(childPaths("/", ["sys"])).toEqual(["/sys"]);
  });

  it("give ancestors and containment", () => {
    expect(pathsAbove("/usr/scene/Ball")).toEqual(["/", "/usr", "/usr/scene"]);
    expect(parentPath("/usr")).toBe("/");
    expect(parentPath("/")).toBeNull();
    expect(isWithin("/usr/scene", "/usr")).toBe(true);
    expect(isWithin("/usr2", "/usr")).toBe(false);
  });
});

describe("a tree", () => {
  it("requests the children of an opened node, and shows them when they arrive", () => {
    const model = sampleTree();
    expect(model.wanted()).toBeNull();
    model.setOpen("/usr", true);
    expect(model.wanted()).toBe("/usr");
    model.fill("/usr", inner("usr", [leaf("scene")]));
    expect(model.wanted()).toBeNull();
    expect(paths(model)).toEqual(["/", "/sys", "/usr", "/usr/scene"]);
  });

  it("does not request children again after a failure", () => {
    const model = sampleTree();
    model.setOpen("/usr", true);
    model.failed("/usr");
    expect(model.wanted()).toBeNull();
  });

  it("keeps nodes open when robots come and go", () => {
    const model = sampleTree();
    model.setOpen("/usr", true);
    model.fill("/usr", inner("usr", [closed("Robot", 1), closed("Ball", 1)]));
    model.setOpen("/usr/Ball", true);
    model.fill("/usr/Ball", inner("Ball", [leaf("physics")]));
    expect(model.loaded()).toEqual(["/", "/usr", "/usr/Ball"]);
    model.fill("/usr", inner("usr", [closed("Ball", 1), closed("Other", 3)]));
    expect(paths(model)).toEqual(["/", "/sys", "/usr", "/usr/Ball", "/usr/Ball/physics", "/usr/Other"]);
    expect(model.node("/usr/Robot")).toBeUndefined();
  });

  it("discards the children of a node whose class has changed", () => {
    const model = sampleTree();
    model.fill("/usr", inner("usr", [inner("x", [leaf("y")], "A")]));
    expect(model.node("/usr/x/y")).toBeDefined();
    model.fill("/usr", inner("usr", [closed("x", 1, "B")]));
    expect(model.node("/usr/x/y")).toBeUndefined();
    expect(model.node("/usr/x")!.children).toBeNull();
  });

  it("reports step by step what to load to reveal a path", () => {
    const model = sampleTree();
    expect(model.reveal("/usr/scene/Ball")).toBe("/usr");
    model.fill("/usr", inner("usr", [closed("scene", 1)]));
    expect(model.reveal("/usr/scene/Ball")).toBe("/usr/scene");
    model.fill("/usr/scene", inner("scene", [leaf("Ball")]));
    expect(model.reveal("/usr/scene/Ball")).toBeNull();
    expect(paths(model)).toContain("/usr/scene/Ball");
    expect(model.reveal("/usr/nothing/Ball")).toBeNull();
  });

  it("supports the usual keys of trees", () => {
    const model = sampleTree();
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

  it("with a filter shows matches and their ancestors, and loads more nodes", () => {
    const model = sampleTree();
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

  it("stops loading at its limit", () => {
    const model = new TreeModel(3);
    model.fill("/", inner("", [closed("sys", 2), closed("usr", 1)]));
    model.filter = "x";
    expect(model.wanted()).toBeNull();
  });

  it("moves the focus away from removed rows", () => {
    const model = sampleTree();
    model.focus = "/usr";
    model.fill("/", inner("", [closed("sys", 2)]));
    expect(model.focus).toBe("/");
  });
});
