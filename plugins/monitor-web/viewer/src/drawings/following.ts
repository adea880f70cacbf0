/// Decides when objects attached to robots must be repositioned: with each new frame, and again when the next picture
/// is drawn, because only then the world matrices of that frame are known.
export class Following {
  private frame = -1;
  private left = 0;

  /// `anew`: the attached objects themselves changed.
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
