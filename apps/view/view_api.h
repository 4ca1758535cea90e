#pragma once
// The requests of a window's page, as its script sends them (README.md lists them).

#include "apps/view/picture_source.h"
#include "apps/view/web_server.h"

namespace gatelight::apps {

class ViewApi {
 public:
  /// The source must outlive it.
  explicit ViewApi(PictureSource& source) : source_(source) {}

  /// Any thread may call it. Never throws: what a request does wrong is in its answer, as {"error": "..."}.
  WebResponse answer(const WebRequest& request);

 private:
  WebResponse route(const WebRequest& request, const std::string& viewer);
  WebResponse scene(const std::string& viewer);
  WebResponse change(const WebRequest& request, const std::string& viewer);
  WebResponse picture(const WebRequest& request, const std::string& viewer);
  WebResponse status(const std::string& viewer);
  WebResponse pixel(const WebRequest& request, const std::string& viewer);
  WebResponse save(const WebRequest& request, const std::string& viewer);

  PictureSource& source_;
};

}  // namespace gatelight::apps
