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
      .doc("Problems that are otherwise logged are errors; overrides the loose switches.");
  d.property("evalDigits6", &I::rule<&R::evalDigits6>, &I::setRule<&R::evalDigits6>)
      .doc("Every eval rounds to single precision and six significant digits, as in the installed base.");
  d.property("integerDivision", &I::rule<&R::integerDivision>, &I::setRule<&R::integerDivision>)
      .doc("The quotient of two integers is rounded down.");
  d.property("looseArguments", &I::rule<&R::looseArguments>, &I::setRule<&R::looseArguments>)
      .doc("Calls with wrong arguments are skipped with a warning, once for each place.");
  d.property("looseImports", &I::rule<&R::looseImports>, &I::setRule<&R::looseImports>)
      .doc("An import within a file that fails is logged, as in the installed base; false: it is an error.");
  d.property("defineByName", &I::rule<&R::defineByName>, &I::setRule<&R::defineByName>)
      .doc(
          "Each name has its own value. false: definitions and parameters share one list, in which names "
          "refer to wrong values when arguments are missing.");
  d.property("looseTrailingParen", &I::rule<&R::looseTrailingParen>, &I::setRule<&R::looseTrailingParen>)
      .doc("Text after the body of a file is ignored.");
  d.property("unlinkOnCompleteScenes", &I::unlinkOnCompleteScenes_)
      .doc("A complete scene replaces all nodes below its root; for monitors.");
  d.property("unlinkOnUnreadable", &I::unlinkOnUnreadable_)
      .doc("A file with broken brackets empties its root, as in the installed base.");
  d.property("maxDepth", &I::maxDepth, &I::setMaxDepth).range(1, 256).doc("Maximum nesting of imports.");
  d.property("maxImports", &I::maxImports, &I::setMaxImports)
      .min(1)
      .doc("Maximum number of files of one import, nested ones included.");
  d.property("maxNodes", &I::maxNodes, &I::setMaxNodes)
      .min(1)
      .doc("Maximum number of nodes that one import creates, nested imports included.");
  d.property("argumentLimit", &I::argumentLimit_)
      .unit("1")
      .min(0)
      .doc("Largest number that an import from outside may pass as argument.");
  d.property("keptBytes", &I::keptBytes_)
      .unit("bytes")
      .min(0)
      .doc("Total length of the texts whose compiled form is cached.");
  d.property("filesParsed", &I::filesParsed_)
      .readOnly()
      .doc("Files compiled so far. A second robot of the same kind adds none.");
  d.property("imports", &I::imports_).readOnly().doc("Files imported so far.");
  d.property("evals", &I::evals_).readOnly().doc("Expressions evaluated so far.");
  d.property("calls", &I::calls_).readOnly().doc("Method calls made so far.");
}

std::shared_ptr<const rsg::Program> RsgImporter::load(const std::string& file, Node& root) {
  // An outermost import compares the stamp of a file once, so it sees only one version of it.
  const auto cached = cache_.find(file);
  if (cached != cache_.end() && cached->second.checked == outermost_) return cached->second.program;
  auto& files = kernel().root().require<IFileServer>();
  const std::uint64_t stamp = files.stamp(file);
  if (cached != cache_.end() && stamp != 0 && cached->second.stamp == stamp) {
    cached->second.checked = outermost_;
    return cached->second.program;
  }

  // Not in the cache, or outdated.
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

void RsgImporter::keep(const std::string& file, Cached cached) {
  if (const auto known = cache_.find(file); known != cache_.end()) kept_ -= known->second.bytes;
  kept_ += cached.bytes;
  cache_.insert_or_assign(file, std::move(cached));

  // Remove the least recently used files, but none that the current import uses.
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
      throw Error(fmt::format("cannot import '{}': argument {} is '{}': {}", file, texts.size() + 1,
                              v.plain().substr(0, 80), why));
    };
    if (v.isList() || v.isNil()) refuse("expected a text, a number or a bool");
    std::string text = v.plain();
    if (text.size() > rsg::kMaxText) refuse(fmt::format("expected at most {} bytes", rsg::kMaxText));

    // An import from outside: limit the magnitude of numbers.
    if (frames_.empty()) {
      const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
      double number = 0;
      const auto r = std::from_chars(begin, text.data() + text.size(), number);
      const bool whole = r.ptr == text.data() + text.size() && !text.empty();
      if (whole && (r.ec == std::errc::result_out_of_range || !(std::abs(number) <= argumentLimit_)))
        refuse(fmt::format("expected a number of at most {}", Value(argumentLimit_).text()));
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

void RsgImporter::exhausted(const std::string& message) {
  budget_.exhausted = true;
  throw Error(message);
}

void RsgImporter::import(std::string_view file, Node& root, const List& arguments) {
  // The outermost import starts with a full budget.
  const std::string name(file);
  if (frames_.empty()) {
    budget_.imports = budget_.nodes = 0;
    budget_.exhausted = false;
    ++outermost_;
  }
  if (const std::size_t maxDepth = budget_.maxDepth; frames_.size() >= maxDepth)
    throw Error(fmt::format("'{}' is imported {} deep: does a file import itself? At most {} are allowed ({}.maxDepth)",
                            name, frames_.size(), maxDepth, path()));
  if (++budget_.imports > budget_.maxImports)
    exhausted(fmt::format("too many imports: at most {} are allowed ({}.maxImports)", budget_.maxImports, path()));

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
