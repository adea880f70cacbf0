#include "rsg_importer.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "run.h"
#include "spark/error.h"

namespace spark {

void RsgImporter::describe(Description<RsgImporter>& d) {
  using I = RsgImporter;
  using R = rsg::Rules;
  d.doc("Imports scene files of the RSG language.");
  d.implements<ISceneImporter>();
  d.property("strict", &I::rule<&R::strict>, &I::setRule<&R::strict>)
      .doc("Whatever is otherwise only logged is an error; wins over the loose switches.");
  d.property("evalDigits6", &I::rule<&R::evalDigits6>, &I::setRule<&R::evalDigits6>)
      .doc("Every eval rounds to six significant digits, as the installed base does.");
  d.property("integerDivision", &I::rule<&R::integerDivision>, &I::setRule<&R::integerDivision>)
      .doc("Two integers divide to the floor.");
  d.property("looseArguments", &I::rule<&R::looseArguments>, &I::setRule<&R::looseArguments>)
      .doc("Calls with wrong arguments are skipped with a warning, once for each place.");
  d.property("defineByName", &I::rule<&R::defineByName>, &I::setRule<&R::defineByName>)
      .doc(
          "Each name has its own value; off: definitions and parameters share one list that drifts when arguments are "
          "missing.");
  d.property("looseTrailingParen", &I::rule<&R::looseTrailingParen>, &I::setRule<&R::looseTrailingParen>)
      .doc("What follows a file's body is ignored.");
  d.property("unlinkOnCompleteScenes", &I::unlinkOnCompleteScenes_)
      .doc("A complete scene replaces what is below its root; for monitors.");
  d.property("unlinkOnUnreadable", &I::unlinkOnUnreadable_)
      .doc("A file with broken brackets empties its root, as the original did.");
  d.property("maxDepth", &I::maxDepth, &I::setMaxDepth).range(1, 256).doc("Imports within imports.");
  d.property("maxImports", &I::maxImports, &I::setMaxImports).min(1).doc("Files that one import may import in all.");
  d.property("maxNodes", &I::maxNodes, &I::setMaxNodes).min(1).doc("Nodes that one import may make in all.");
  d.property("argumentLimit", &I::argumentLimit_)
      .unit("1")
      .min(0)
      .doc("Largest number that an import from outside may pass.");
  d.property("keptBytes", &I::keptBytes_)
      .unit("bytes")
      .min(0)
      .doc("Compiled files are kept for the next import up to so much text.");
  d.property("filesParsed", &I::filesParsed_)
      .readOnly()
      .doc("Files read and compiled so far; a second robot of a kind adds none.");
  d.property("imports", &I::imports_).readOnly().doc("Files imported so far.");
  d.property("evals", &I::evals_).readOnly().doc("Expressions evaluated so far.");
  d.property("calls", &I::calls_).readOnly().doc("Method calls made so far.");
}

std::shared_ptr<const rsg::Program> RsgImporter::load(const std::string& file, Node& root) {
  // One import sees one version of a file, however often it needs it.
  const auto cached = cache_.find(file);
  if (cached != cache_.end() && cached->second.checked == outermost_) return cached->second.program;
  auto& files = kernel().root().require<IFileServer>();
  const std::uint64_t stamp = files.stamp(file);
  if (cached != cache_.end() && stamp != 0 && cached->second.stamp == stamp) {
    cached->second.checked = outermost_;
    return cached->second.program;
  }
  const std::string text = files.read(file);
  ++filesParsed_;
  std::shared_ptr<const rsg::Program> program;
  try {
    program = rsg::compile(file, text, {rules_.looseTrailingParen && !rules_.strict});
  } catch (const Error&) {
    if (unlinkOnUnreadable_) root.removeChildren();
    throw;
  }
  keep(file, {stamp, outermost_, static_cast<std::int64_t>(text.size()), program});
  return program;
}

/// Those that were not imported for the longest go first; what the import under way has seen stays.
void RsgImporter::keep(const std::string& file, Cached cached) {
  if (const auto known = cache_.find(file); known != cache_.end()) kept_ -= known->second.bytes;
  kept_ += cached.bytes;
  cache_.insert_or_assign(file, std::move(cached));
  while (kept_ > keptBytes_) {
    const auto oldest = std::min_element(
        cache_.begin(), cache_.end(), [](const auto& a, const auto& b) { return a.second.checked < b.second.checked; });
    if (oldest->second.checked == outermost_) return;
    kept_ -= oldest->second.bytes;
    cache_.erase(oldest);
  }
}

std::vector<std::string> RsgImporter::textsOf(std::string_view file, const List& arguments) const {
  std::vector<std::string> texts;
  for (const Value& v : arguments) {
    const auto refuse = [&](const std::string& why) {
      throw Error("cannot import '" + std::string(file) + "': argument " + std::to_string(texts.size() + 1) + " is '" +
                  v.plain().substr(0, 80) + "': " + why);
    };
    if (v.isList() || v.isNil()) refuse("expected a text, a number or a bool");
    std::string text = v.plain();
    if (text.size() > rsg::kMaxText) refuse("expected at most " + std::to_string(rsg::kMaxText) + " bytes");
    if (frames_.empty()) {
      const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
      double number = 0;
      const auto r = std::from_chars(begin, text.data() + text.size(), number);
      const bool whole = r.ptr == text.data() + text.size() && !text.empty();
      if (whole && (r.ec == std::errc::result_out_of_range || !(std::abs(number) <= argumentLimit_)))
        refuse("expected a number of at most " + Value(argumentLimit_).text());
    }
    texts.push_back(std::move(text));
  }
  return texts;
}

std::string RsgImporter::chain() const {
  std::string out;
  for (std::size_t i = frames_.size(); i-- > 1;)
    out += (out.empty() ? " (imported from " : ", from ") + rsg::where(*frames_[i - 1].program, frames_[i - 1].site);
  return out.empty() ? out : out + ")";
}

void RsgImporter::exhausted(const std::string& sentence) {
  budget_.exhausted = true;
  throw Error(sentence);
}

void RsgImporter::import(std::string_view file, Node& root, const List& arguments) {
  const std::string name(file);
  if (frames_.empty()) {
    budget_.imports = budget_.nodes = 0;
    budget_.exhausted = false;
    ++outermost_;
  }
  if (frames_.size() >= static_cast<std::size_t>(budget_.maxDepth))
    throw Error("'" + name + "' is imported " + std::to_string(frames_.size()) +
                " deep: does a file import itself? At most " + std::to_string(budget_.maxDepth) + " are allowed (" +
                path() + ".maxDepth)");
  if (++budget_.imports > budget_.maxImports)
    exhausted("too many imports: at most " + std::to_string(budget_.maxImports) + " are allowed (" + path() +
              ".maxImports)");
  std::vector<std::string> texts = textsOf(name, arguments);
  const std::shared_ptr<const rsg::Program> program = load(name, root);
  if (unlinkOnCompleteScenes_ && !program->delta && frames_.empty()) root.removeChildren();
  ++imports_;

  struct Guard {
    std::vector<rsg::Frame>& frames;
    ~Guard() { frames.pop_back(); }
  };
  frames_.push_back({program.get(), {}});
  const Guard guard{frames_};
  rsg::Run(*this, *program, std::move(texts)).execute(root);
}

}  // namespace spark
