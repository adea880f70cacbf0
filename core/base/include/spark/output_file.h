#pragma once
/// \file
/// Files that this process writes. Nothing that exists is replaced unless the user says so, and no file is written by
/// two at once.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "spark/abi/spark/output_file.h"

namespace spark {

/// What this process may write: rules for all of its simulations, as a umask is for all of its files. Programs set them
/// before they build simulations. All functions may be called by any thread.
namespace outputs {

/// From now on files that exist may be replaced, as with `--force`. Initially false.
void setReplace(bool replace);
/// From now on only files below `folder` are written, those that permit() names, and what the user asks for meanwhile
/// (ByUser). For runs that are built from a recording: what a recording names is not the user's choice.
void confine(const std::string& folder);
/// The user has named this file: it may be written, and the programs that it lists may be started, by a confined run.
void permit(const std::string& file);
/// True if a simulation may write the file, or may start programs that it lists.
bool permitted(const std::string& file);
/// This process reads the file, so it is never replaced.
void keep(const std::string& file);

/// While an object of it lives, what its thread does was asked for by the user, such as by sparkctl.
class ByUser {
 public:
  ByUser();
  ~ByUser();
  ByUser(const ByUser&) = delete;
  ByUser& operator=(const ByUser&) = delete;
};

/// While an object of it lives, its thread writes no file: files are checked, and what is written is dropped.
class Trial {
 public:
  Trial();
  ~Trial();
  Trial(const Trial&) = delete;
  Trial& operator=(const Trial&) = delete;
  /// The files that would have been written, as absolute paths in the order of their names.
  const std::vector<std::string>& files() const { return files_; }

 private:
  friend void check(const std::string& file, std::string_view what, bool continues);
  Trial* outer_;
  std::vector<std::string> files_;
};

/// True in a thread with a Trial.
bool isTrial();
/// Throws Error if OutputFile would not open the file. Creates nothing. `what`: what it is, for the error: "the log".
/// `continues`: what exists is not replaced, but continued.
void check(const std::string& file, std::string_view what, bool continues = false);
/// Throws Error unless `descriptor`, of a file that is being written, is the only one that writes it; it is closed by
/// its owner. What is no regular file may have several.
void lock(int descriptor, const std::string& file, std::string_view what);

}  // namespace outputs

/// A file that is being written, from its beginning. Regular files are locked until it is closed. One thread at a time.
class OutputFile {
 public:
  /// Opens it. `what`: what it is, for errors: "the recording". Throws Error if it cannot be opened, or has content and
  /// may not be replaced, or is written by another program, or is read by this one.
  OutputFile(const std::string& file, std::string_view what);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Writes bytes. Where the file is a pipe that takes none for the moment, it waits until `giveUp` returns true, which
  /// is called several times a second. Throws Error.
  void write(std::string_view bytes, const std::function<bool()>& giveUp = {});
  /// For system calls; owned by this object.
  int descriptor() const { return descriptor_; }
  /// Closes and removes it again, if this object has created it.
  void discard();

 private:
  std::string file_, what_;
  int descriptor_ = -1;
  bool created_ = false;
};

/// A regular file that appears, or is replaced, as a whole. Until then its content is in a new file beside it.
class FileDraft {
 public:
  /// Checks `file` and begins a draft. A link is followed. `what` as for OutputFile; `replace` true: a file that exists
  /// may be replaced, whatever the rules are. Throws Error as OutputFile does, and if something else than a file is
  /// there.
  FileDraft(const std::string& file, std::string_view what, bool replace = false);
  /// Removes the draft unless finish() was called.
  ~FileDraft();
  FileDraft(const FileDraft&) = delete;
  FileDraft& operator=(const FileDraft&) = delete;

  /// Throws Error.
  void write(std::string_view bytes);
  /// The draft's name.
  const std::string& name() const { return draft_; }
  /// Gives it the name of the file. Throws Error.
  void finish();

 private:
  [[noreturn]] void fail(int error) const;
  std::string file_, what_, target_, draft_;
  bool replace_ = false;
  int descriptor_ = -1;
};

}  // namespace spark
