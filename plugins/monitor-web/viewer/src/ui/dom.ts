/// Creates elements in one line, and sets properties only if they changed.

type Attribute = string | number | boolean | null | undefined | ((event: never) => void);
type Child = Node | string | null | undefined | false;

/// `h("button", { class: "button", onclick: run }, "Text")`. Functions become listeners; true is an empty attribute.
export function h<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Record<string, Attribute> = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name.replace(/^on/, ""), value as EventListener);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false && value != null) element.setAttribute(name, String(value));
  }
  element.append(...children.filter((c): c is Node | string => c !== null && c !== undefined && c !== false));
  return element;
}

export function setText(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

/// null removes the attribute.
export function setAttribute(element: Element, name: string, value: string | null): void {
  if (element.getAttribute(name) === value) return;
  if (value === null) element.removeAttribute(name);
  else element.setAttribute(name, value);
}

export function setHidden(element: HTMLElement, hidden: boolean): void {
  if (element.hidden !== hidden) element.hidden = hidden;
}

/// Returns true at most once every `period` milliseconds.
export class Pace {
  private last = -Infinity;
  constructor(private readonly period: number) {}
  due(now: number): boolean {
    if (now - this.last < this.period) return false;
    this.last = now;
    return true;
  }
  /// Makes the next call return true.
  hurry(): void {
    this.last = -Infinity;
  }
}
