import { describe, expect, it } from "vitest";
import { luminance, rgb } from "../../src/view/palette";
import { kDefaults, kPalettes, paletteFor, settingsFrom } from "../../src/ui/settings";

describe("settings", () => {
  it("are restored as they were stored", () => {
    const settings = { theme: "light", quality: "quality", lights: "plain", labels: false, sound: true, view: "top", palette: 2 };
    expect(settingsFrom(JSON.stringify(settings))).toEqual(settings);
  });
  it("have defaults for invalid values", () => {
    for (const text of [null, "", "[", "7", "null", '{"theme":"pink","palette":99,"labels":"yes","lights":1,"sound":"loud"}']) expect(settingsFrom(text)).toEqual(kDefaults);
  });
});

describe("team colors", () => {
  it("differ in lightness, so the teams can be distinguished without hues", () => {
    const light = (hex: string) => luminance(rgb(parseInt(hex.slice(1), 16))) + 0.05;
    for (const { left, right, name } of kPalettes) {
      const [a, b] = [light(left), light(right)];
      expect(Math.max(a, b) / Math.min(a, b), name).toBeGreaterThan(1.6);
    }
  });
  it("follow the teams' names unless the user chose others", () => {
    expect(paletteFor(0, "Red", "Blue")).toEqual({ name: "Red and Blue", left: "#f4593b", right: "#1f5fd6" });
    expect(paletteFor(0, "Violet", "Gold").name).toBe("Violet and gold");
    expect(paletteFor(3, "Red", "Blue")).toBe(kPalettes[3]);
  });
  it("are blue and orange for all other names", () => {
    expect(paletteFor(0, "Red", "Green")).toBe(kPalettes[0]);
    expect(paletteFor(0, "", "")).toBe(kPalettes[0]);
  });
});
