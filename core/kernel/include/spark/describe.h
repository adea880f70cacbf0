#pragma once
/// \file
/// The builder by which every class describes itself, in `static void describe(spark::Description<Self>& d)`.
///
///     static void describe(spark::Description<DragController>& d) {
///       d.doc("Slows its body in proportion to its speed.");
///       d.property("linearDrag", &DragController::linear_).unit("N s/m").min(0).doc("Force per speed.");
///       d.method("stop", &DragController::stop).doc("Takes the body's speed away.");
///       d.link(&DragController::body_, Above<IRigidBody>());
///       d.on<&DragController::prepare>(phase::kPrepare);
///     }

#include <tuple>
#include <type_traits>
#include <utility>

#include "spark/abi/spark/describe.h"
#include "spark/channel_name.h"
#include "spark/class_object.h"
#include "spark/error.h"

namespace spark {

/// Adds details to a property. Returned by Description::property.
class PropertyBuilder {
 public:
  /// For property `index` of `d`, which must outlive the builder.
  explicit PropertyBuilder(ClassDescription& d, std::size_t index) : d_(d), index_(index) {}
  /// One sentence about the property.
  PropertyBuilder& doc(std::string text) { return get().doc = std::move(text), *this; }
  /// Its unit, such as "m" or "rad/s".
  PropertyBuilder& unit(std::string text) { return get().unit = std::move(text), *this; }
  /// The minimum of each number.
  PropertyBuilder& min(double v) { return get().min = v, *this; }
  /// The maximum of each number.
  PropertyBuilder& max(double v) { return get().max = v, *this; }
  /// The range of each number: `lo` to `hi`, both included.
  PropertyBuilder& range(double lo, double hi) { return min(lo).max(hi); }
  /// The allowed texts; all others are refused.
  PropertyBuilder& choices(std::vector<std::string> texts) { return get().choices = std::move(texts), *this; }
  /// The property is part of the state hash and of saved state.
  PropertyBuilder& state() { return get().state = true, *this; }
  /// The property is part of what the class's saveState() saves, or follows from it, such as a body's velocity. It is
  /// in the state hash by way of saveState(), and not in the hash of the configuration.
  PropertyBuilder& savedByClass() { return get().savedByClass = true, *this; }
  /// The property tells of the process and not of the simulation: times on the clock, counts since the start, what a
  /// cache holds, where the host listens or has its files. It is in no hash: a run from saved state has other values.
  PropertyBuilder& ofProcess() { return get().ofProcess = true, *this; }
  /// The property cannot be set.
  PropertyBuilder& readOnly() { return get().readOnly = true, get().set = nullptr, *this; }

 private:
  Property& get() { return d_.properties[index_]; }
  ClassDescription& d_;
  std::size_t index_;
};

/// Adds details to a method. Returned by Description::method.
class MethodBuilder {
 public:
  /// For method `index` of `d`, which must outlive the builder.
  explicit MethodBuilder(ClassDescription& d, std::size_t index) : d_(d), index_(index) {}
  /// One sentence about the method.
  MethodBuilder& doc(std::string text) { return get().doc = std::move(text), *this; }
  /// The names of the parameters in order, with units: `{"axis", "angle [deg]"}`.
  MethodBuilder& parameters(std::vector<std::string> names) {
    auto& p = get().parameters;
    for (std::size_t i = 0; i < p.size() && i < names.size(); ++i) p[i] = names[i] + ": " + p[i];
    return *this;
  }
  /// Callers may omit the last `n` plain arguments, which then are value-initialised.
  MethodBuilder& optional(int n) { return get().minScalars -= n, *this; }
  /// Scene files may pass more arguments than the method reads.
  MethodBuilder& surplusIgnored() { return get().surplusIgnored = true, *this; }

 private:
  Method& get() { return d_.methods[index_]; }
  ClassDescription& d_;
  std::size_t index_;
};

/// Adds details to a link. Returned by Description::link.
class LinkBuilder {
 public:
  /// For `link`, which must outlive the builder.
  explicit LinkBuilder(LinkDescription& link) : link_(link) {}
  /// One sentence about the link.
  LinkBuilder& doc(std::string text) { return link_.doc = std::move(text), *this; }
  /// The object needs the link: when it joins the tree and there is no target, a warning is logged that ends with
  /// `hint`.
  LinkBuilder& required(std::string hint) { return link_.lacks = std::move(hint), *this; }

 private:
  LinkDescription& link_;
};

namespace detail {
template <class F>
concept MemberFunction = std::is_member_function_pointer_v<F>;
template <class M>
concept ObjectType = std::is_object_v<M>;
template <class C, class T>
concept BaseOf = std::is_base_of_v<C, T>;

/// Result and decayed arguments of a member function pointer.
template <class F>
struct Signature;
template <class C, class R, class... A>
struct Signature<R (C::*)(A...)> {
  using Result = R;
  template <template <class...> class To>
  using Arguments = To<std::decay_t<A>...>;
  static constexpr std::size_t kCount = sizeof...(A);
};
template <class C, class R, class... A>
struct Signature<R (C::*)(A...) const> : Signature<R (C::*)(A...)> {};
template <class C, class R, class... A>
struct Signature<R (C::*)(A...) noexcept> : Signature<R (C::*)(A...)> {};
template <class C, class R, class... A>
struct Signature<R (C::*)(A...) const noexcept> : Signature<R (C::*)(A...)> {};

/// The parameters of a method.
template <class... A>
struct Pack {
  static constexpr bool kRest = ((Convert<A>::kScalars < 0) || ... || false);
  static constexpr int kScalars = (0 + ... + (Convert<A>::kScalars < 0 ? 0 : Convert<A>::kScalars));
  static std::vector<std::string> typeNames() { return {Convert<A>::typeName()...}; }
  /// Reads the arguments from left to right, which the braces guarantee. Omitted ones are value-initialised.
  static std::tuple<A...> read(Args& args) { return std::tuple<A...>{one<A>(args)...}; }
  template <class T>
  static T one(Args& args) {
    // Static memory is zero before construction; a vector's constructor may leave its numbers uninitialised.
    static const T kNone{};
    if (args.atEnd() && Convert<T>::kScalars > 0) return kNone;
    return Convert<T>::from(args);
  }
};
}  // namespace detail

/// The description of a class that is being made.
template <class T>
class Description {
 public:
  /// Fills `d`, which must outlive this object.
  explicit Description(ClassDescription& d) : d_(d) {}

  /// One sentence about the class.
  void doc(std::string text) { d_.doc = std::move(text); }

  /// A property that is a data member, own or inherited.
  template <detail::ObjectType M, detail::BaseOf<T> C>
  PropertyBuilder property(std::string name, M C::*member) {
    return addProperty(
        std::move(name), Convert<M>::typeName(), Convert<M>::kScalars,
        [member](const Leaf& l) { return Convert<M>::to(static_cast<const T&>(l).*member); },
        [member](Leaf& l, Args& a) { static_cast<T&>(l).*member = Convert<M>::from(a); });
  }
  /// A read-only property with a getter.
  template <detail::MemberFunction G>
  PropertyBuilder property(std::string name, G getter) {
    using V = std::decay_t<typename detail::Signature<G>::Result>;
    return addProperty(
        std::move(name), Convert<V>::typeName(), Convert<V>::kScalars,
        [getter](const Leaf& l) { return Convert<V>::to((const_cast<T&>(static_cast<const T&>(l)).*getter)()); },
        nullptr);
  }
  /// A property with a getter and a setter of one argument.
  template <detail::MemberFunction G, detail::MemberFunction S>
  PropertyBuilder property(std::string name, G getter, S setter) {
    using V = std::decay_t<typename detail::Signature<G>::Result>;
    return addProperty(
        std::move(name), Convert<V>::typeName(), Convert<V>::kScalars,
        [getter](const Leaf& l) { return Convert<V>::to((const_cast<T&>(static_cast<const T&>(l)).*getter)()); },
        [setter](Leaf& l, Args& a) { (static_cast<T&>(l).*setter)(Convert<V>::from(a)); });
  }

  /// A method. Arguments and result are converted, and the number of arguments is checked.
  template <detail::MemberFunction F>
  MethodBuilder method(std::string name, F function) {
    using S = detail::Signature<F>;
    using P = typename S::template Arguments<detail::Pack>;
    Method m;
    m.name = std::move(name);
    m.parameters = P::typeNames();
    m.minScalars = P::kScalars;
    m.maxScalars = P::kRest ? -1 : P::kScalars;
    if constexpr (!std::is_void_v<typename S::Result>)
      m.returns = Convert<std::decay_t<typename S::Result>>::typeName();
    m.call = [function](Leaf& l, Args& a) -> Value {
      auto bound = P::read(a);
      return std::apply(
          [&](auto&... args) -> Value {
            if constexpr (std::is_void_v<typename S::Result>) {
              (static_cast<T&>(l).*function)(std::move(args)...);
              return {};
            } else {
              return Convert<std::decay_t<typename S::Result>>::to((static_cast<T&>(l).*function)(std::move(args)...));
            }
          },
          bound);
    };
    d_.methods.push_back(std::move(m));
    return MethodBuilder(d_, d_.methods.size() - 1);
  }

  /// A second name for a method that was described before or is inherited.
  void alias(std::string name, std::string method) {
    Method m;
    m.name = std::move(name);
    m.doc = "The same as " + method + ".";
    m.returns = "@" + std::move(method);  // ClassObject::method follows it
    d_.methods.push_back(std::move(m));
  }

  /// The class implements interface I, from which it must derive.
  template <class I>
  void implements() {
    static_assert(std::is_base_of_v<I, T>);
    d_.interfaces.push_back({I::kInterface, [](Leaf* l) -> void* { return static_cast<I*>(static_cast<T*>(l)); }});
  }

  /// A link: a member that leads to the object at the end of a route (link.h).
  template <class L, bool kKnows, detail::BaseOf<T> C>
  LinkBuilder link(Link<L, kKnows> C::*member, Route<L> route) {
    return addLink(std::move(route), false,
                   [member](Leaf& l) -> detail::LinkBase& { return static_cast<T&>(l).*member; });
  }
  /// A link to all objects at the end of a route.
  template <class L, detail::BaseOf<T> C>
  LinkBuilder link(Links<L> C::*member, Route<L> route) {
    return addLink(std::move(route), true,
                   [member](Leaf& l) -> detail::LinkBase& { return static_cast<T&>(l).*member; });
  }

  /// A hook: every linked object of the class handles the event by `void T::F(const Event&)`.
  template <auto F>
  void on(ChannelName channel) {
    d_.hooks.push_back({channel.text(), [](Leaf& l, const Event& e) { (static_cast<T&>(l).*F)(e); }});
  }

  /// The class is abstract: only a base, without objects of its own.
  void abstract() { d_.make = nullptr; }

 private:
  PropertyBuilder addProperty(std::string name, std::string type, int scalars, std::function<Value(const Leaf&)> get,
                              std::function<void(Leaf&, Args&)> set) {
    Property p;
    p.name = std::move(name);
    p.type = std::move(type);
    p.scalars = scalars;
    p.readOnly = !set;
    p.get = std::move(get);
    p.set = std::move(set);
    d_.properties.push_back(std::move(p));
    return PropertyBuilder(d_, d_.properties.size() - 1);
  }
  LinkBuilder addLink(AnyRoute route, bool all, std::function<detail::LinkBase&(Leaf&)> member) {
    d_.links.push_back({std::move(route), all, "", "", std::move(member)});
    return LinkBuilder(d_.links.back());
  }
  ClassDescription& d_;
};

/// Makes the description of class T: what T::describe() adds, and name, base, factory and the class as an interface.
template <class T>
ClassDescription describeClass() {
  static_assert(std::is_same_v<typename T::ClassSelf, T>, "the class lacks SPARK_CLASS(Self, Base)");
  static_assert(std::is_base_of_v<typename T::ClassBase, T>,
                "SPARK_CLASS names a base that the class does not derive from");
  ClassDescription d;
  d.name = T::kClassName;
  if constexpr (!std::is_same_v<T, Leaf>) d.base = T::ClassBase::kClassName;
  d.interfaces.push_back({T::kInterface, [](Leaf* l) -> void* { return static_cast<T*>(l); }});
  if constexpr (!std::is_abstract_v<T> && std::is_default_constructible_v<T>)
    d.make = []() -> std::unique_ptr<Leaf> { return std::make_unique<T>(); };
  Description<T> description(d);
  T::describe(description);
  return d;
}

}  // namespace spark
