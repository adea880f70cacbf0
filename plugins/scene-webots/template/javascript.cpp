#include "javascript.h"

#include <fmt/format.h>
#include <js/CompilationAndEvaluation.h>
#include <js/CompileOptions.h>
#include <js/Conversions.h>
#include <js/Exception.h>
#include <js/Initialization.h>
#include <js/SourceText.h>
#include <jsapi.h>

#include <stdexcept>

#include "texts.h"

namespace spark::templates {

namespace {

constexpr std::size_t kStack = 512 << 10;  ///< bytes, so that a deep recursion is an exception

/// The engine, for the whole life of the program. Without compiled code: templates are short, and memory can then be
/// limited.
JSContext* engine() {
  static JSContext* const context = [] {
    JS::DisableJitBackend();
    JSContext* const made = JS_Init() ? JS_NewContext(kMostMemory) : nullptr;
    if (!made || !JS::InitSelfHostedCode(made)) throw std::runtime_error("the engine of Javascript cannot begin");
    JS_SetNativeStackQuota(made, kStack);
    return made;
  }();
  return context;
}

struct Run {
  const Request& request;
  Reply& reply;
};
Run& runOf(JSContext* cx) { return *static_cast<Run*>(JS_GetContextPrivate(cx)); }

bool toText(JSContext* cx, JS::HandleValue value, std::string& out) {
  JS::RootedString text(cx, JS::ToString(cx, value));
  if (!text) return false;
  const JS::UniqueChars bytes = JS_EncodeStringToUTF8(cx, text);
  if (!bytes) return false;
  out = bytes.get();
  return true;
}

bool write(JSContext* cx, unsigned count, JS::Value* values) {
  const JS::CallArgs arguments = JS::CallArgsFromVp(count, values);
  double piece = 0;
  if (!JS::ToNumber(cx, arguments.get(0), &piece)) return false;
  Reply& reply = runOf(cx).reply;
  bool fits = false;
  if (count < 2) {
    fits = reply.write(piece);
  } else {
    std::string text;
    if (!toText(cx, arguments[1], text)) return false;
    fits = reply.write(piece, std::move(text));
  }
  arguments.rval().setUndefined();
  if (!fits) JS_ReportErrorASCII(cx, "the template writes more than %d MiB", static_cast<int>(kMostWritten >> 20));
  return fits;
}

bool say(JSContext* cx, unsigned count, JS::Value* values) {
  const JS::CallArgs arguments = JS::CallArgsFromVp(count, values);
  std::string text;
  if (!toText(cx, arguments.get(0), text)) return false;
  runOf(cx).reply.say(text);
  arguments.rval().setUndefined();
  return true;
}

/// The request's fields and context, in JSON.
bool request(JSContext* cx, unsigned count, JS::Value* values) {
  const JS::CallArgs arguments = JS::CallArgsFromVp(count, values);
  const Request& r = runOf(cx).request;
  const std::string text = nlohmann::json{{"fields", r.fields}, {"context", r.context}}.dump(
      -1, ' ', true, nlohmann::json::error_handler_t::replace);
  JS::RootedString out(cx, JS_NewStringCopyN(cx, text.data(), text.size()));
  if (!out) return false;
  arguments.rval().setString(out);
  return true;
}

bool evaluate(JSContext* cx, std::string_view text, const char* name, JS::MutableHandleValue out) {
  JS::CompileOptions options(cx);
  options.setFileAndLine(name, 1);
  JS::SourceText<mozilla::Utf8Unit> source;
  return source.init(cx, text.data(), text.size(), JS::SourceOwnership::Borrowed) &&
         JS::Evaluate(cx, options, source, out);
}

/// The program of the template as the function of modules.js makes it, run.
bool runProgram(JSContext* cx, JS::HandleObject global, const std::string& text) {
  JS::RootedValue prepare(cx), program(cx), ignored(cx);
  if (!evaluate(cx, kJavascriptModules, "modules", &prepare)) return false;
  const JS::UTF8Chars bytes(text.data(), text.size());
  JS::RootedString given(cx, JS_NewStringCopyUTF8N(cx, bytes));
  if (!given) return false;
  JS::RootedValueArray<1> arguments(cx);
  arguments[0].setString(given);
  if (!JS_CallFunctionValue(cx, global, prepare, arguments, &program)) return false;
  std::string made;
  return toText(cx, program, made) && evaluate(cx, made, "line", &ignored);
}

/// "line:3: TypeError: ...", as Lua has it.
std::string failure(JSContext* cx) {
  JS::ExceptionStack exception(cx);
  JS::ErrorReportBuilder report(cx);
  if (!JS::GetPendingExceptionStack(cx, &exception) || !JS::StealPendingExceptionStack(cx, &exception) ||
      !report.init(cx, exception, JS::ErrorReportBuilder::NoSideEffects))
    return fmt::format("it needs more than {} MiB of memory", kMostMemory >> 20);
  const char* const file = report.report()->filename;
  const std::string text = report.toStringResult().c_str();
  return file && std::string_view(file) == "line" ? fmt::format("line:{}: {}", report.report()->lineno, text) : text;
}

}  // namespace

void runJavascript(const Request& given, Reply& reply) {
  JSContext* const cx = engine();
  Run run{given, reply};
  JS_SetContextPrivate(cx, &run);
  static constexpr JSClass kGlobal = {"global", JSCLASS_GLOBAL_FLAGS, &JS::DefaultGlobalClassOps};
  JS::RealmOptions options;
  JS::RootedObject global(cx, JS_NewGlobalObject(cx, &kGlobal, nullptr, JS::FireOnNewGlobalHook, options));
  if (!global) {
    reply.error = "no memory for Javascript";
    return;
  }
  const JSAutoRealm realm(cx, global);
  if (!JS_DefineFunction(cx, global, "spark$write", write, 2, 0) ||
      !JS_DefineFunction(cx, global, "spark$say", say, 1, 0) ||
      !JS_DefineFunction(cx, global, "spark$request", request, 0, 0) || !runProgram(cx, global, given.text))
    reply.error = failure(cx);
  JS_SetContextPrivate(cx, nullptr);
}

}  // namespace spark::templates
