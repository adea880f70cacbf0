// Only the stage, with a log:
// ?file=URL&view=broadcast&quality=quality&theme=light&at=SECONDS&paused&fixed&select=left:3
import { openReplay } from "../../src/sources";
import { type CameraMode, type Quality, Stage, type Theme } from "../../src/view/stage";

const wanted = new URLSearchParams(location.search);
const stage = new Stage(document.getElementById("stage")!);
const source = await openReplay(wanted.get("file")!);
stage.quality = (wanted.get("quality") as Quality) ?? "flat";
stage.theme = (wanted.get("theme") as Theme) ?? "dark";
stage.adaptive = !wanted.has("fixed");
stage.setSource(source);
source.seek(Number(wanted.get("at") ?? 0));
source.playing = !wanted.has("paused");
stage.onpick = pick => stage.select(pick?.robot?.key ?? pick?.node ?? null);
addEventListener("keydown", event => stage.camera.key(event));
addEventListener("keyup", event => stage.camera.key(event));
requestAnimationFrame(function picture(now) {
  stage.render(now);
  requestAnimationFrame(picture);
});
stage.camera.mode = (wanted.get("view") as CameraMode) ?? "orbit";
if (wanted.has("select")) stage.select(wanted.get("select"));
Object.assign(window, { stage, source });
