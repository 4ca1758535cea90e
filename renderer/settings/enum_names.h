#pragma once
// The names of the enumerations on the command line and in files: one table each, for both directions.

#include <array>
#include <iterator>
#include <span>
#include <string>
#include <string_view>

#include "renderer/image/tonemap.h"
#include "renderer/settings/aovs.h"
#include "renderer/settings/presets.h"

namespace gatelight::renderer {

/// A name and its value.
template <typename Value>
struct Choice {
  std::string_view name;
  Value value;
};

template <typename Value>
using Choices = std::span<const Choice<Value>>;

/// The name of a value in a table; empty where it has none.
template <typename Table, typename Value>
std::string name_of(const Table& table, const Value& value) {
  for (const auto& choice : table) {
    if (choice.value == value) return std::string(choice.name);
  }
  return "";
}

/// Every enumerator, in the order of the enumeration.
template <class Enumeration>
inline constexpr Choices<Enumeration> kEnumNames;

template <>
inline constexpr Choice<Integrator> kEnumNames<Integrator>[] = {
    {"path", Integrator::path}, {"ao", Integrator::ao}, {"nao", Integrator::nao}, {"nrc", Integrator::nrc}};
template <>
inline constexpr Choice<MisHeuristic> kEnumNames<MisHeuristic>[] = {{"balance", MisHeuristic::balance},
                                                                    {"power", MisHeuristic::power}};
template <>
inline constexpr Choice<DirectLight> kEnumNames<DirectLight>[] = {
    {"mis", DirectLight::mis}, {"nee", DirectLight::nee}, {"bsdf", DirectLight::bsdf}};
template <>
inline constexpr Choice<GlassShadows> kEnumNames<GlassShadows>[] = {{"refract", GlassShadows::refract},
                                                                    {"straight", GlassShadows::straight}};
template <>
inline constexpr Choice<Watertight> kEnumNames<Watertight>[] = {
    {"on", Watertight::on}, {"off", Watertight::off}, {"auto", Watertight::automatic}};
template <>
inline constexpr Choice<Projection> kEnumNames<Projection>[] = {{"camera", Projection::camera},
                                                                {"perspective", Projection::perspective},
                                                                {"orthographic", Projection::orthographic},
                                                                {"panorama", Projection::panorama}};
template <>
inline constexpr Choice<PixelFilter> kEnumNames<PixelFilter>[] = {
    {"box", PixelFilter::box},
    {"tent", PixelFilter::tent},
    {"gaussian", PixelFilter::gaussian},
    {"blackman-harris", PixelFilter::blackman_harris}};
template <>
inline constexpr Choice<NanPolicy> kEnumNames<NanPolicy>[] = {{"drop", NanPolicy::drop},
                                                              {"error", NanPolicy::error}};
template <>
inline constexpr Choice<DenoiserKind> kEnumNames<DenoiserKind>[] = {
    {"auto", DenoiserKind::automatic}, {"oidn", DenoiserKind::oidn}, {"none", DenoiserKind::none}};
template <>
inline constexpr Choice<Prefilter> kEnumNames<Prefilter>[] = {
    {"accurate", Prefilter::accurate}, {"fast", Prefilter::fast}, {"none", Prefilter::none}};
template <>
inline constexpr auto kEnumNames<Aov> = [] {
  std::array<Choice<Aov>, std::size(kAovs)> names{};
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = {kAovs[i].name, kAovs[i].aov};
  return names;
}();
template <>
inline constexpr Choice<MatteKind> kEnumNames<MatteKind>[] = {{"object", MatteKind::object},
                                                              {"material", MatteKind::material}};
template <>
inline constexpr Choice<SamplerKind> kEnumNames<SamplerKind>[] = {{"sobol", SamplerKind::sobol},
                                                                  {"screen", SamplerKind::screen},
                                                                  {"independent", SamplerKind::independent}};
template <>
inline constexpr Choice<LightSelection> kEnumNames<LightSelection>[] = {{"tree", LightSelection::tree},
                                                                        {"power", LightSelection::power}};
template <>
inline constexpr Choice<CachedComponent> kEnumNames<CachedComponent>[] = {
    {"all", CachedComponent::all},
    {"no-delta", CachedComponent::no_delta},
    {"indirect", CachedComponent::indirect}};
template <>
inline constexpr Choice<QueryAt> kEnumNames<QueryAt>[] = {{"primary", QueryAt::primary},
                                                          {"gather", QueryAt::gather},
                                                          {"spread", QueryAt::spread},
                                                          {"none", QueryAt::none}};
template <>
inline constexpr Choice<CacheOutput> kEnumNames<CacheOutput>[] = {{"final", CacheOutput::final},
                                                                  {"cache", CacheOutput::cache}};
template <>
inline constexpr Choice<TrainingSource> kEnumNames<TrainingSource>[] = {{"picture", TrainingSource::picture},
                                                                        {"camera", TrainingSource::camera},
                                                                        {"surface", TrainingSource::surface}};
template <>
inline constexpr Choice<CachePreset> kEnumNames<CachePreset>[] = {
    {"bare", CachePreset::bare},           {"preview", CachePreset::preview},
    {"standard", CachePreset::standard},   {"final", CachePreset::final},
    {"paper-nao", CachePreset::paper_nao}, {"paper-nrc", CachePreset::paper_nrc}};
template <>
inline constexpr Choice<Tonemap> kEnumNames<Tonemap>[] = {{"none", Tonemap::none},
                                                          {"filmic", Tonemap::filmic},
                                                          {"neutral", Tonemap::neutral},
                                                          {"aces", Tonemap::aces},
                                                          {"agx", Tonemap::agx}};
template <>
inline constexpr Choice<neural::FeatureEncoding> kEnumNames<neural::FeatureEncoding>[] = {
    {"none", neural::FeatureEncoding::none},
    {"gate", neural::FeatureEncoding::gate},
    {"hashgrid", neural::FeatureEncoding::hash_grid}};
template <>
inline constexpr Choice<neural::ResolutionRule> kEnumNames<neural::ResolutionRule>[] = {
    {"uniform", neural::ResolutionRule::uniform},
    {"paper", neural::ResolutionRule::paper},
    {"fixed", neural::ResolutionRule::fixed}};
template <>
inline constexpr Choice<neural::NodeStorage> kEnumNames<neural::NodeStorage>[] = {
    {"shared", neural::NodeStorage::shared}, {"per-triangle", neural::NodeStorage::per_triangle}};
template <>
inline constexpr Choice<neural::Loss> kEnumNames<neural::Loss>[] = {
    {"l2", neural::Loss::l2}, {"relative-l2", neural::Loss::relative_l2}};
template <>
inline constexpr Choice<neural::FeatureUpdate> kEnumNames<neural::FeatureUpdate>[] = {
    {"sparse", neural::FeatureUpdate::sparse}, {"dense", neural::FeatureUpdate::dense}};
template <>
inline constexpr Choice<neural::FeatureStep> kEnumNames<neural::FeatureStep>[] = {
    {"per-node", neural::FeatureStep::per_node}, {"per-triangle", neural::FeatureStep::per_triangle}};
template <>
inline constexpr Choice<neural::FeaturePrecision> kEnumNames<neural::FeaturePrecision>[] = {
    {"fp32", neural::FeaturePrecision::fp32},
    {"fp16", neural::FeaturePrecision::fp16_masters},
    {"fp16-only", neural::FeaturePrecision::fp16}};

template <class Enumeration>
std::string enum_name(Enumeration value) {
  return name_of(kEnumNames<Enumeration>, value);
}

}  // namespace gatelight::renderer
