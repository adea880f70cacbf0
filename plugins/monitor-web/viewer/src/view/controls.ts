import type { Camera } from "./camera";

const clickPixels = 6, clickTime = 500;

interface Finger {
  x: number;
  y: number;
}

/// Mouse and touch: one finger or the left button rotates, two fingers or another button pan, wheel and pinch zoom.
/// Short presses are clicks.
export class Controls {
  onclick: ((x: number, y: number) => void) | null = null;
  private readonly fingers = new Map<number, Finger>();
  private pressed: { x: number; y: number; time: number } | null = null;
  private sliding = false;
  private readonly off = new AbortController();

  constructor(private readonly element: HTMLElement, private readonly camera: Camera) {
    const { signal } = this.off;
    element.style.touchAction = "none";
    element.addEventListener("pointerdown", e => this.down(e), { signal });
    element.addEventListener("pointermove", e => this.move(e), { signal });
    for (const type of ["pointerup", "pointercancel"] as const) element.addEventListener(type, e => this.up(e), { signal });
    element.addEventListener("wheel", e => this.wheel(e), { signal, passive: false });
    element.addEventListener("contextmenu", e => e.preventDefault(), { signal });
  }

  dispose(): void {
    this.off.abort();
  }

  private down(event: PointerEvent): void {
    this.element.setPointerCapture(event.pointerId);
    this.fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.sliding = event.button !== 0 || event.shiftKey;
    this.pressed = this.fingers.size === 1 && event.button === 0 ? { x: event.clientX, y: event.clientY, time: event.timeStamp } : null;
  }

  private move(event: PointerEvent): void {
    const finger = this.fingers.get(event.pointerId);
    if (!finger) return;
    const [dx, dy] = [event.clientX - finger.x, event.clientY - finger.y];
    if (this.pressed && Math.hypot(event.clientX - this.pressed.x, event.clientY - this.pressed.y) > clickPixels) this.pressed = null;
    if (this.pressed) return;
    const height = this.element.clientHeight || 1;
    if (this.fingers.size === 1) {
      if (this.sliding) this.camera.slide(dx / height, dy / height);
      else this.camera.drag(dx / height, dy / height);
    } else if (this.fingers.size === 2) {
      this.pinch(event, finger, dx / height, dy / height);
    }
    finger.x = event.clientX;
    finger.y = event.clientY;
  }

  private pinch(event: PointerEvent, moved: Finger, right: number, down: number): void {
    const other = [...this.fingers.values()].find(finger => finger !== moved)!;
    const before = Math.atan2(moved.y - other.y, moved.x - other.x), after = Math.atan2(event.clientY - other.y, event.clientX - other.x);
    const apart = Math.hypot(moved.x - other.x, moved.y - other.y), now = Math.hypot(event.clientX - other.x, event.clientY - other.y);
    if (apart > 10 && now > 10) this.camera.zoom(apart / now);
    this.camera.twist(Math.atan2(Math.sin(after - before), Math.cos(after - before)));
    this.camera.slide(right / 2, down / 2);
  }

  private up(event: PointerEvent): void {
    this.fingers.delete(event.pointerId);
    const { pressed } = this;
    this.pressed = null;
    if (pressed && event.type === "pointerup" && event.timeStamp - pressed.time < clickTime) this.onclick?.(event.clientX, event.clientY);
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 33 : 1;
    this.camera.zoom(Math.exp(Math.max(-200, Math.min(200, event.deltaY * lines)) * 0.0016));
  }
}
