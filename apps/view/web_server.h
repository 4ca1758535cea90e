#pragma once
// Answers requests of browsers on this machine, behind a secret address. The rest of the program sees no HTTP
// library.

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace gatelight::apps {

struct WebRequest {
  std::string method;  ///< GET or POST
  std::string path;    ///< behind the secret part: "", "view.css", "api/status"
  std::map<std::string, std::string> query;
  std::string body;
};

struct WebResponse {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  std::map<std::string, std::string> headers;
};

using AnswerRequest = std::function<WebResponse(const WebRequest&)>;

class WebServer {
 public:
  /// Listens on the loopback interface only. `port`: 0 for any free one. `answer` is called by several
  /// threads. Throws OutputError where the port cannot be had.
  WebServer(int port, AnswerRequest answer);
  ~WebServer();

  /// "http://127.0.0.1:PORT/SECRET/". The secret part has 128 random bits. Requests without it, or for
  /// another host, as those of a page elsewhere, get an empty 404.
  const std::string& address() const;
  int port() const;

  /// Serves until stop() is called.
  void serve();
  /// Returns when no request is answered any more. Any thread but one that answers may call it.
  void stop();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace gatelight::apps
