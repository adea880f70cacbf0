import { describe, expect, it } from "vitest";
import { ruleTitle } from "../../src/ui/rule_switches";

describe("the title of a rule", () => {
  it("is its name in words, without the word that all have", () => {
    expect(["OffsideAspect", "KickInRule", "TouchingFoulAspect", "sumo"].map(ruleTitle)).toEqual(["Offside", "Kick in", "Touching foul", "Sumo"]);
  });
  it("is its name where nothing else is left", () => {
    expect(["Rule", "Aspect"].map(ruleTitle)).toEqual(["Rule", "Aspect"]);
  });
});
