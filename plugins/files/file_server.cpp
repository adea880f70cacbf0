#include "file_server.h"

#include <fmt/format.h>

#include <vector>

#include "spark/error.h"
#include "spark/kernel.h"

namespace spark::files {

std::string normalName(std::string_view resource) {
  const auto refuse = [&](const char* why) {
    std::string shown(resource);
    for (char& c : shown)
      if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    throw Error(
        fmt::format("expected a relative resource name such as 'rsg/agent/sphere.rsg', found '{}': {}", shown, why));
  };
  if (resource.empty()) refuse("it is empty");
  if (resource.size() > 1024)
    throw Error(fmt::format("expected a resource name of at most 1024 bytes, found one of {}", resource.size()));
  if (resource.front() == '/') refuse("it is absolute");
  for (const char c : resource) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) refuse("it holds a control character");
    if (c == '\\') refuse("it holds a backslash; use '/'");
    if (c == ':') refuse("it holds a ':'");
  }

  // Copy the components.
  std::string out;
  while (!resource.empty()) {
    const std::size_t n = std::min(resource.find('/'), resource.size());
    const std::string_view part = resource.substr(0, n);
    resource.remove_prefix(std::min(n + 1, resource.size()));
    if (part.empty() || part == ".") continue;
    if (part == "..") throw Error("expected a resource name that stays inside, found one with '..'");
    out.append(out.empty() ? "" : "/").append(part);
  }
  if (out.empty()) throw Error("expected a resource name, found only dots and slashes");
  return out;
}

}  // namespace spark::files

namespace spark {

void FileServer::describe(Description<FileServer>& d) {
  d.doc("Finds resources by name in the file systems below it, in their order.");
  d.implements<IFileServer>();
  d.method("read", &FileServer::readText).parameters({"resource"}).doc("Returns the content of a resource.");
  d.method("exist", &FileServer::hasResource).parameters({"resource"}).doc("True when a file system has the resource.");
}

template <class F>
void FileServer::forEach(F visit) const {
  const Node* const ofProgram = kernel().root().find<Node>(kOfProgram);
  for (const Node* const node : {ofProgram, static_cast<const Node*>(this)}) {
    if (!node || (node == this && node == ofProgram)) continue;
    for (const auto& child : node->children())
      if (auto system = child->as<IFileSystem>())
        if (visit(*system)) return;
  }
}

std::string FileServer::read(std::string_view resource) {
  const std::string name = files::normalName(resource);
  std::optional<std::string> content;
  std::optional<Error> failure;  // of the first file system that has the resource but cannot read it
  forEach([&](IFileSystem& system) {
    try {
      content = system.read(name);
    } catch (const Error& e) {
      if (!failure) failure = e;
    }
    return content.has_value();
  });
  if (content) {
    kernel().sources().add("file", name, *content);
    return *std::move(content);
  }
  if (failure) throw *failure;
  notFound(name);
}

bool FileServer::exists(std::string_view resource) { return stamp(resource) != 0; }

std::uint64_t FileServer::stamp(std::string_view resource) {
  const std::string name = files::normalName(resource);
  std::uint64_t stamp = 0, number = 0;
  forEach([&](IFileSystem& system) {
    ++number;
    stamp = system.stamp(name);
    return stamp != 0;
  });
  // The number of the file system is part of the stamp: files in two folders may have the same age.
  return stamp == 0 ? 0 : std::max<std::uint64_t>(1, stamp ^ (number << 56));
}

std::optional<std::filesystem::path> FileServer::hostFile(std::string_view resource) {
  const std::string name = files::normalName(resource);
  std::optional<std::filesystem::path> path;
  forEach([&](IFileSystem& system) {
    if (system.stamp(name) == 0) return false;
    path = system.hostFile(name);
    return true;
  });
  return path;
}

void FileServer::notFound(const std::string& name) const {
  std::string places;
  forEach([&](IFileSystem& system) {
    places += (places.empty() ? "" : ", ") + system.where();
    return false;
  });
  const std::string hint = places.empty()
                               ? fmt::format("{} has no file systems below it: add a DirectoryFileSystem.", path())
                               : fmt::format("Looked in {}.", places);
  throw Error(fmt::format("there is no resource '{}'. {}", name, hint));
}

}  // namespace spark
