/// Lets the user pick a point on the field with the next click on the picture.
import { type Camera, Vector3 } from "three";
import { h } from "./dom";
import type { Point } from "./places";

/// A pointer that moved further than this is a drag, which moves the camera and picks nothing [px].
const kSlip = 6;

/// Intersection of the plane z = 0 with the ray through a point of the picture (0..1 from the left and the top); null
/// above the horizon.
export function groundBelow(camera: Camera, right: number, down: number): Point | null {
  const from = new Vector3(right * 2 - 1, 1 - down * 2, -1).unproject(camera);
  const to = new Vector3(right * 2 - 1, 1 - down * 2, 1).unproject(camera);
  const along = from.z / (from.z - to.z);
  if (!(along > 0 && along <= 1)) return null;
  const { x, y } = from.lerp(to, along);
  return [x, y, 0];
}

export class FieldPicker {
  private readonly words = h("span");
  readonly banner = h(
    "div",
    { class: "banner card", role: "status", "data-testid": "pick-banner", hidden: true },
    this.words,
    h("button", { type: "button", class: "button", onclick: () => this.finish(null) }, "Cancel"),
  );
  private answer: ((point: Point | null) => void) | null = null;
  private down = { x: 0, y: 0 };

  constructor(private readonly area: HTMLElement, surface: HTMLElement, private readonly camera: () => Camera) {
    surface.addEventListener("pointerdown", (event) => (this.down = { x: event.clientX, y: event.clientY }), { capture: true });
    surface.addEventListener("click", (event) => this.clicked(event, surface));
  }

  get picking(): boolean {
    return this.answer !== null;
  }

  pick(what: string): Promise<Point | null> {
    this.finish(null);
    this.words.textContent = what;
    this.banner.hidden = false;
    this.area.toggleAttribute("data-picking", true);
    return new Promise((resolve) => (this.answer = resolve));
  }

  finish(point: Point | null): void {
    const answer = this.answer;
    this.answer = null;
    this.banner.hidden = true;
    this.area.removeAttribute("data-picking");
    answer?.(point);
  }

  private clicked(event: MouseEvent, surface: HTMLElement): void {
    if (!this.answer || Math.hypot(event.clientX - this.down.x, event.clientY - this.down.y) > kSlip) return;
    const box = surface.getBoundingClientRect();
    const point = groundBelow(this.camera(), (event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    if (point) this.finish(point);
  }
}
