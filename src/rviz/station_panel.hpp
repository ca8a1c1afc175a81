// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QComboBox>
#include <QElapsedTimer>
#include <QKeySequence>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QSlider>
#include <QTimer>
#include <QVBoxLayout>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <rviz/panel.h>

#include "rviz/parameter_list.hpp"
#include "rviz/preset_row.hpp"
#include "rviz/scope_widget.hpp"
#include "rviz/station_link.hpp"
#include "rviz/take_list.hpp"
#include "rviz/widgets.hpp"

namespace ergotic::panel {

/// `ergotic/StationPanel`: the station as a player sees and handles it. docs/ros.md has the keys.
/// Its settings are the name of the station. Thread: the one of the window, which never waits for
/// ROS.
class StationPanel : public rviz::Panel {
 public:
  explicit StationPanel(QWidget* parent = nullptr);
  ~StationPanel() override;

  void onInitialize() override;
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;
  QSize sizeHint() const override { return {350, 700}; }

 private:
  void addForce(QVBoxLayout* column);
  void addInstruments(QVBoxLayout* column);
  void addParameters(QVBoxLayout* column);
  void addPresets(QVBoxLayout* column);
  void addMeters(QVBoxLayout* column);
  void addSound(QVBoxLayout* column);
  void addTakes(QVBoxLayout* column);
  TakeList::Acts takeActs();
  void addMessages(QVBoxLayout* column);
  QPushButton* addButton(const QString& text, const QString& tip);
  std::function<void()> press(void (StationLink::*act)());
  void addKeys();
  void bind(const QKeySequence& keys,
            const std::function<void()>& act,
            bool also_ambiguous = false);

  void connect();
  void refresh();
  void showForce();
  void showInstruments();
  void choose(const SceneEntry& scene);
  void showMeters();
  void showSound();
  void showTakes();
  void showMessages();
  void showDevice();
  bool isStale() const { return lampOf(news_.status.state, news_.age_s) == Lamp::kStale; }

  std::string models_;                 // folder of the package's scenes
  std::string wanted_;                 // name of the station
  std::unique_ptr<StationLink> link_;  // to it, from the next refresh on
  News news_;
  QElapsedTimer clock_;
  QTimer timer_;
  std::size_t scenes_shown_ = 0;
  std::size_t log_shown_ = 0;
  std::size_t takes_shown_ = 0;
  std::size_t device_shown_ = 0;
  std::string model_shown_;

  QScrollArea* scroll_ = nullptr;  // all below the buttons of force
  LampWidget* lamp_ = nullptr;
  QPushButton* engage_ = nullptr;
  QPushButton* stop_ = nullptr;
  QPushButton* recover_ = nullptr;
  QPushButton* emergency_ = nullptr;
  Paragraph* answer_ = nullptr;
  QComboBox* instruments_ = nullptr;
  QPushButton* reload_ = nullptr;
  Paragraph* about_ = nullptr;
  QLabel* verdict_ = nullptr;
  ParameterList* parameters_ = nullptr;
  PresetRow* presets_ = nullptr;
  QLabel* force_title_ = nullptr;
  ForceMeter* forces_ = nullptr;
  QProgressBar* load_ = nullptr;
  Paragraph* rates_ = nullptr;
  QLabel* sound_title_ = nullptr;
  SoundMeter* sound_ = nullptr;
  QPushButton* watch_ = nullptr;
  ScopeWidget* scope_ = nullptr;
  QSlider* volume_ = nullptr;
  QPushButton* mute_ = nullptr;
  QLabel* takes_title_ = nullptr;
  TakeList* takes_ = nullptr;
  QPushButton* record_ = nullptr;
  QPushButton* replay_ = nullptr;
  QPlainTextEdit* messages_ = nullptr;
  QLineEdit* station_ = nullptr;
};

}  // namespace ergotic::panel
