import { expect, it } from "vitest";
import type { Inspectable, TreeAnswer } from "../../src/inspect/inspectable";
import { TreeLoader } from "../../src/inspect/tree_loader";
import { TreeModel } from "../../src/inspect/tree_model";

/// A host whose answers the test sends.
class SlowHost {
  ready = true;
  asked: string[] = [];
  private waiting: { give: (answer: TreeAnswer) => void; refuse: (why: Error) => void }[] = [];
  tree(path: string): Promise<TreeAnswer> {
    this.asked.push(path);
    return new Promise((give, refuse) => this.waiting.push({ give, refuse }));
  }
  async answer(...names: string[]): Promise<void> {
    this.waiting.shift()!.give({ name: "", class: "N", doc: "", children: names.map((name) => ({ name, class: "N", doc: "", children: [], more: 1 })) });
    await Promise.resolve();
  }
  async refuse(): Promise<void> {
    this.waiting.shift()!.refuse(new Error("no such node"));
    await new Promise((done) => queueMicrotask(() => done(null)));
  }
}

it("sends one request at a time until a path is revealed", async () => {
  const host = new SlowHost();
  const model = new TreeModel();
  const loader = new TreeLoader(host as unknown as Inspectable, model);
  loader.reveal("/usr/scene/Ball");
  loader.pump();
  expect(host.asked).toEqual(["/"]);
  await host.answer("usr");
  expect(host.asked).toEqual(["/", "/usr"]);
  await host.answer("scene");
  await host.answer("Ball");
  expect(host.asked).toEqual(["/", "/usr", "/usr/scene"]);
  expect(model.rows.at(-1)!.path).toBe("/usr/scene/Ball");
});

it("reloads open nodes, and reports errors of the host", async () => {
  const host = new SlowHost();
  const model = new TreeModel();
  const loader = new TreeLoader(host as unknown as Inspectable, model);
  loader.pump();
  await host.answer("usr");
  loader.refresh();
  expect(host.asked).toEqual(["/", "/"]);
  await host.answer("sys");
  expect(model.rows.map((r) => r.path)).toEqual(["/", "/sys"]);
  model.setOpen("/sys", true);
  loader.pump();
  await host.refuse();
  expect(loader.error).toBe("no such node");
  expect(host.asked).toEqual(["/", "/", "/sys"]);
});

it("waits until the host is ready", () => {
  const host = new SlowHost();
  host.ready = false;
  const loader = new TreeLoader(host as unknown as Inspectable, new TreeModel());
  loader.pump();
  expect(host.asked).toEqual([]);
  host.ready = true;
  loader.pump();
  expect(host.asked).toEqual(["/"]);
});

it("ignores an answer after it was closed", async () => {
  const host = new SlowHost();
  const model = new TreeModel();
  const loader = new TreeLoader(host as unknown as Inspectable, model);
  loader.pump();
  loader.close();
  await host.answer("usr");
  expect(model.rows.length).toBe(1);
});
