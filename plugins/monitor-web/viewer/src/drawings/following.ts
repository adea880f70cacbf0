/// Decides when things attached to robots must be placed again: with each new frame, and once more in the picture after it, because only then
/// the picture knows where everything in that frame is.
export class Following {
  private frame = -1;
  private left = 0;

  /// `anew`: what follows is other than before.
  due(frame: number, anew = false): boolean {
    if (frame !== this.frame || anew) {
      this.frame = frame;
      this.left = 2;
    }
    if (this.left === 0) return false;
    --this.left;
    return true;
  }
}
