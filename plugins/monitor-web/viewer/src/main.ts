import "./ui/styles/index.css";
import { Application } from "./ui/application";
import { offer } from "./ui/report";

const root = document.getElementById("app")!;

function run(): void {
  const app = new Application(root, location.href);
  offer(app);
  const frame = (now: number): void => {
    app.frame(now);
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}

try {
  run();
} catch (error) {
  // no WebGL 2: a page that says so instead of an empty one
  root.className = "sorry";
  root.textContent = `The match cannot be drawn here: ${error instanceof Error ? error.message : String(error)}`;
  console.error(error);
}
