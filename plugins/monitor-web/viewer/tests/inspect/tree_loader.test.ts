import { expect, it } from "vitest";
import type { Inspectable, TreeAnswer } from "../../src/inspect/inspectable";
import { TreeLoader } from "../../src/inspect/tree_loader";
import { TreeModel } from "../../src/inspect/tree_model";

/// A host whose answers come when the test says so.
class Slow {
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

it("asks one question at a time until a path is revealed", async () => {
  const host = new Slow();
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

it("asks again for what is open, and says what the host refuses", async () => {
  const host = new Slow();
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

it("waits until somebody would answer", () => {
  const host = new Slow();
  host.ready = false;
  const loader = new TreeLoader(host as unknown as Inspectable, new TreeModel());
  loader.pump();
  expect(host.asked).toEqual([]);
  host.ready = true;
  loader.pump();
  expect(host.asked).toEqual(["/"]);
});

it("takes no answer after it was closed", async () => {
  const host = new Slow();
  const model = new TreeModel();
  const loader = new TreeLoader(host as unknown as Inspectable, model);
  loader.pump();
  loader.close();
  await host.answer("usr");
  expect(model.rows.length).toBe(1);
});
