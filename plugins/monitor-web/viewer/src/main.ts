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
  // without WebGL 2, the page shows an error message
  root.className = "sorry";
  root.textContent = `The match cannot be drawn here: ${error instanceof Error ? error.message : String(error)}`;
  console.error(error);
}
