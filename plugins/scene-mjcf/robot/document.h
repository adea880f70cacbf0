#pragma once
/// \file
/// MJCF files: elements with their places, attributes with their defaults, included files.

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "spark/error.h"

namespace spark::mjcf {

/// A file and what it consists of.
struct File {
  std::string name, text;
  pugi::xml_document xml;
};

/// "12:5" for an offset into a text.
std::string lineAndColumn(std::string_view text, std::size_t offset);
/// Reads the text as XML. Throws Error with file:line:column for a text that is none, or that has no element.
void parse(File& file);
/// The name of the first element of a text that may be XML, behind declarations and comments; "" if there is none.
std::string_view firstTag(std::string_view text);

/// An element of a file. Valid as long as its Document.
struct Element {
  pugi::xml_node node;
  const File* file = nullptr;
  // Of a file that is not XML, for errors: where the element begins, and its type and name. `node` is empty then.
  std::size_t offset = 0;
  std::string_view type{}, name{};
  std::string_view tag() const { return node ? node.name() : type; }
  /// "robot.xml:12:5"; a tab counts as one column.
  std::string where() const;
  /// The place and a text, to be thrown.
  Error error(const std::string& text) const { return Error(where() + ": " + text); }
  /// "<motor> 'name'", or "<motor>" without a name; without brackets where the file is not XML.
  std::string named() const;
  /// The same and its place: "<motor> 'name' (robot.xml:12:5)".
  std::string placed() const { return named() + " (" + where() + ")"; }
};

/// Reads a file by its name. Throws Error.
using ReadFile = std::function<std::string(const std::string& name)>;

/// A model: its main file, with what it includes in the places of the `include` elements.
class Document {
 public:
  /// Largest nesting of included files and of default classes, largest number of files, and of elements that may be
  /// listed, included ones counted as often as they are.
  static constexpr int kMaxDepth = 200, kMaxFiles = 100, kMaxListed = 1'000'000;

  /// Throws Error with file:line:column for a text that is not XML or not a model.
  Document(const std::string& name, ReadFile read);
  /// The folder of the main file: "" or "a/b/".
  const std::string& folder() const { return folder_; }
  /// The element `mujoco`.
  Element root() const { return {files_.front()->xml.document_element(), files_.front().get()}; }
  /// The elements in `e`, with included ones. Throws Error for files that cannot be included.
  std::vector<Element> children(const Element& e);

 private:
  Element load(const std::string& name, const Element* from);
  void append(const Element& e, std::vector<Element>& out, int depth);

  std::string folder_;
  ReadFile read_;
  std::vector<std::unique_ptr<File>> files_;
  int listed_ = 0;
};

/// The default classes of a model (MuJoCo's documentation, "Default settings").
class Defaults {
 public:
  /// Adds what the element `default` says. Throws Error.
  void add(Document& document, const Element& element);
  /// Calls visit(element) for the elements that apply to an element of one of these tags and that class, the nearest
  /// first. Throws Error, with the place of `user`, when there is no such class.
  void forEach(const Element& user, std::span<const std::string_view> tags, const std::string& name,
               const std::function<void(const Element&)>& visit) const;

 private:
  struct Class {
    std::string parent;
    std::vector<Element> elements;  ///< in the order of the file
  };
  void add(Document& document, const Element& element, const std::string& parent, int depth);
  std::map<std::string, Class, std::less<>> classes_;
};

/// A file that is too large: no part of it is left out for that.
class LimitError : public Error {
 public:
  using Error::Error;
};

/// What of a model is not supported, or is changed: elements, attributes and combinations of them.
class Unsupported {
 public:
  void element(const Element& e);
  void attribute(const Element& e, const std::string& name);
  /// Something else: one sentence per `what`, with the first place. The same of one element counts once.
  void add(const Element& e, const std::string& what) { add(e, what, what); }
  /// Does `work` for an element. If it fails, the element is named with the reason, as left out, and false is returned.
  /// Those that fail because of the same place elsewhere, such as a mesh, are one kind. Throws LimitError.
  bool attempt(const Element& e, const std::function<void()>& work);
  /// "a.xml:3:4: the element <tendon> is not supported (and 3 more)", in order of the first places.
  std::vector<std::string> sentences() const;

 private:
  /// `kind`: of which only the first is written.
  void add(const Element& e, const std::string& what, const std::string& kind);
  static constexpr std::size_t kMaxKinds = 100;  ///< more are counted only
  struct Entry {
    std::string what, where;
    int times = 0;
  };
  std::vector<Entry> entries_;
  std::set<std::pair<const void*, std::string>> seen_;     ///< elements and what was said of them
  std::map<std::string, std::size_t, std::less<>> known_;  ///< kinds: index in entries_
  int more_ = 0;
};

/// The attributes of an element, with those of its default classes. What is read is known; finish() names the others.
class Attributes {
 public:
  /// `className` "": the default class of the whole model. `tag`: of the elements that hold its defaults; "": its own.
  Attributes(const Element& e, const Defaults& defaults, const std::string& className, Unsupported& unsupported,
             std::string_view tag = "");
  /// Of the element alone.
  Attributes(const Element& e, Unsupported& unsupported) : element_(e), chain_{e}, unsupported_(unsupported) {}
  /// From now on numbers that cannot be read count as not given, which is named; otherwise they are an error.
  Attributes& forgive() {
    forgiving_ = true;
    return *this;
  }
  bool isForgiving() const { return forgiving_; }
  const Element& element() const { return element_; }
  bool has(const char* name) { return find(name) != nullptr; }
  /// "" where it is not there.
  std::string text(const char* name, const char* otherwise = "");
  /// One of `words`. Throws Error for another one.
  std::string word(const char* name, std::initializer_list<const char*> words, const char* otherwise);
  bool flag(const char* name, bool otherwise);
  double number(const char* name, double otherwise);
  /// One below `least` or above `most` becomes that, which is named.
  double within(const char* name, double otherwise, double least, double most = HUGE_VAL);
  /// One that is not whole loses its fraction, which is named. Throws Error.
  int integer(const char* name, int otherwise);
  /// Between `least` and `most` finite numbers; nullopt where the attribute is not there. Throws Error.
  std::optional<std::vector<double>> numbers(const char* name, std::size_t least, std::size_t most);
  /// Writes the first numbers of an array: those of the defaults, then those of the element, which may be fewer. The
  /// others stay.
  template <class Array>
  void fill(const char* name, Array& out) {
    known_.insert(name);
    for (std::size_t k = chain_.size(); k-- > 0;) {
      const auto found = parse(chain_[k], name, 1, static_cast<std::size_t>(out.size()));
      if (!found) continue;
      for (std::size_t i = 0; i < found->size(); ++i) out[static_cast<int>(i)] = (*found)[i];
    }
  }
  /// Writes a whole array, as numbers() reads it. Returns false where the attribute is not there.
  template <class Array>
  bool take(const char* name, Array& out) {
    const auto found = numbers(name, out.size(), out.size());
    if (found)
      for (std::size_t i = 0; i < found->size(); ++i) out[static_cast<int>(i)] = (*found)[i];
    return found.has_value();
  }
  /// Names what is done with a value.
  void note(const std::string& what) { unsupported_.add(element_, what); }
  /// Attributes that mean nothing to a simulation.
  void ignore(std::initializer_list<const char*> names) {
    for (const char* name : names) known_.insert(name);
  }
  /// Names the attributes that were not read.
  void finish();

 private:
  const char* find(const char* name);
  std::optional<std::vector<double>> parse(const Element& e, const char* name, std::size_t least, std::size_t most);
  Element element_;
  std::vector<Element> chain_;  ///< the element, then its defaults
  Unsupported& unsupported_;
  bool forgiving_ = false;
  std::set<std::string, std::less<>> known_{"class"};
};

}  // namespace spark::mjcf
