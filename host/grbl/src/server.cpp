#include "trammel/grbl/server.hpp"

#include <fmt/format.h>

#include <array>

#include "trammel/driver/errors.hpp"

namespace trammel::grbl {
namespace {

void send(transport::ByteStream& stream, const std::string& text) {
  stream.write(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

std::string of_reader(const std::string& bytes) {
  std::string kept;
  for (const char c : bytes) {
    if (c == '?' || c == '!') kept += c;
  }
  return kept;
}

}  // namespace

void Server::write(const std::string& text) {
  for (std::size_t n = 0; n < clients_.size();) {
    try {
      send(*clients_[n], text);
      ++n;
    } catch (const driver::LinkError& error) {
      forget(n, error.what(), nullptr);
    }
  }
}

// Resets the controller, as opening a serial adapter resets an Arduino, but does not interrupt a job.
void Server::greet(Controller& controller) {
  const State state = controller.state();
  const bool rests = state == State::kIdle || state == State::kAlarm || state == State::kCheck;
  if (rests && controller.idle()) controller.receive("\x18");
}

void Server::add(std::unique_ptr<transport::ByteStream> stream, Controller& controller) {
  note_(fmt::format("{} {}", stream->peer(), clients_.empty() ? "sends" : "reads along"));
  clients_.push_back(std::move(stream));
  if (clients_.size() == 1) return greet(controller);
  try {
    send(*clients_.back(), "[MSG:Another client sends: reading along, '?' and '!' are taken]\r\n");
  } catch (const driver::LinkError& error) {
    forget(clients_.size() - 1, error.what(), &controller);
  }
}

void Server::forget(std::size_t index, const std::string& why, Controller* controller) {
  note_(fmt::format("{} has gone: {}", clients_[index]->peer(), why));
  clients_.erase(clients_.begin() + static_cast<std::ptrdiff_t>(index));
  if (index != 0 || clients_.empty() || controller == nullptr) return;
  note_(fmt::format("{} sends now", clients_.front()->peer()));
  write("[MSG:The sending client has gone: the next one sends now]\r\n");
}

bool Server::serve(std::size_t index, Controller& controller) {
  std::array<std::uint8_t, 4096> bytes{};
  try {
    const std::size_t count = clients_[index]->read(bytes.data(), bytes.size(), std::chrono::nanoseconds(0));
    const std::string came(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
    if (clients_[index]->changed_hands() && index == 0) greet(controller);
    controller.receive(index == 0 ? came : of_reader(came));
  } catch (const driver::LinkError& error) {
    forget(index, error.what(), &controller);
    return false;
  }
  return true;
}

void Server::turn(transport::Listener* listener, Controller& controller) {
  if (listener != nullptr) {
    if (auto stream = listener->accept()) add(std::move(stream), controller);
  }
  for (std::size_t n = 0; n < clients_.size();) {
    if (serve(n, controller)) ++n;
  }
}

}  // namespace trammel::grbl
