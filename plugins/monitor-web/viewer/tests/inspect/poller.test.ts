import { expect, it } from "vitest";
import { Poller } from "../../src/inspect/poller";
import { Feed } from "../../src/inspect/overlays/feed";

function asker() {
  const waiting: { give: (v: string) => void; refuse: (e: Error) => void }[] = [];
  const ask = () => new Promise<string>((give, refuse) => waiting.push({ give, refuse }));
  const settle = () => new Promise((done) => queueMicrotask(() => queueMicrotask(() => done(null))));
  return { waiting, ask, settle };
}

it("has at most one pending request, and waits for the interval", async () => {
  const { waiting, ask, settle } = asker();
  const heard: string[] = [];
  const poller = new Poller(ask, (v) => heard.push(v), () => {}, 100);
  poller.tick(0);
  poller.tick(500);
  expect(waiting.length).toBe(1);
  waiting[0]!.give("a");
  await settle();
  expect(heard).toEqual(["a"]);
  poller.tick(50);
  expect(waiting.length).toBe(1);
  poller.tick(100);
  expect(waiting.length).toBe(2);
});

it("waits for a second after a failure", async () => {
  const { waiting, ask, settle } = asker();
  const failures: string[] = [];
  const poller = new Poller(ask, () => {}, (why) => failures.push(why), 100);
  poller.tick(0);
  waiting[0]!.refuse(new Error("unknown request"));
  await settle();
  expect(failures).toEqual(["unknown request"]);
  poller.tick(900);
  expect(waiting.length).toBe(1);
  poller.tick(1000);
  expect(waiting.length).toBe(2);
});

it("ignores answers that arrive after it stopped", async () => {
  const { waiting, ask, settle } = asker();
  const heard: string[] = [];
  const poller = new Poller(ask, (v) => heard.push(v), () => {});
  poller.tick(0);
  poller.stop();
  poller.tick(0);
  waiting[0]!.give("late");
  waiting[1]!.give("new");
  await settle();
  expect(heard).toEqual(["new"]);
});

it("a feed discards the answer when its subject changes", async () => {
  const { waiting, ask, settle } = asker();
  const subjects: string[] = [];
  const feed = new Feed<string>((subject) => (subjects.push(subject), ask()));
  feed.tick(0, null);
  expect(waiting.length).toBe(0);
  feed.tick(0, "/a");
  waiting[0]!.give("of a");
  await settle();
  expect(feed.answer).toBe("of a");
  feed.tick(10, "/b");
  expect(feed.answer).toBeNull();
  expect(subjects).toEqual(["/a", "/b"]);
  feed.tick(20, null);
  waiting[1]!.give("of b");
  await settle();
  expect(feed.answer).toBeNull();
});
