import { describe, expect, it } from "vitest";
import { fileNameOf, streamOf, wishesOf, withoutLog, withoutToken } from "../../src/ui/address";

describe("the address", () => {
  it("has defaults without parameters", () => {
    expect(wishesOf("http://host:3280/")).toEqual({ file: null, at: null, paused: false, view: null, quality: null, theme: null, panel: null, token: null });
  });
  it("selects a log, a time in it, and the view", () => {
    const wishes = wishesOf("http://h/?file=logs/final.log.gz&at=63.5&paused&view=top&quality=quality&theme=light&panel=inspect#token=abc");
    expect(wishes).toEqual({ file: "logs/final.log.gz", at: 63.5, paused: true, view: "top", quality: "quality", theme: "light", panel: "inspect", token: "abc" });
  });
  it("ignores invalid values", () => {
    expect(wishesOf("http://h/?at=soon&view=inside&quality=best&theme=pink&panel=all")).toMatchObject({ at: null, view: null, quality: null, theme: null, panel: null });
  });
  it("can be stripped of the token only", () => {
    expect(withoutToken("http://h/?file=a#token=secret")).toBe("http://h/?file=a");
    expect(withoutToken("http://h/#token=secret&other=1")).toBe("http://h/#other=1");
  });
  it("of the live match has no log", () => {
    expect(withoutLog("http://h/?file=a.log&at=3&paused&view=top")).toBe("http://h/?view=top");
    expect(withoutLog("http://h/")).toBe("http://h/");
  });
  it("gives the stream of the same host, encrypted if the page is", () => {
    expect(streamOf("http://host:3280/?file=a#b")).toBe("ws://host:3280/stream");
    expect(streamOf("https://host/match/")).toBe("wss://host/match/stream");
  });
  it("gives logs a readable name", () => {
    expect(fileNameOf("https://h/logs/semi%20final.log?x=1")).toBe("semi final.log");
    expect(fileNameOf("final.log")).toBe("final.log");
    expect(fileNameOf("logs/100%.log")).toBe("100%.log");
  });
});
