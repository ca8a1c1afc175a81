// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/station_panel.hpp"

#include <QAbstractItemView>
#include <QApplication>
#include <QHBoxLayout>
#include <QIcon>
#include <QMouseEvent>
#include <QPainter>
#include <QScreen>
#include <QScrollBar>
#include <QShortcut>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>
#include <ctime>

#include <pluginlib/class_list_macros.hpp>
#include <ros/package.h>
#include <rviz/config.h>
#include <rviz/visualization_manager.h>

#include "rviz/robot_models.hpp"
#include "rviz/volume_scale.hpp"

namespace ergotic::panel {
namespace {

constexpr int kRefreshMs = 40;
constexpr double kSilence = 1e-4;  // of full scale
const char kUsualStation[] = "/station";
const char kSetting[] = "Station";

/// List of all panels: an emergency stop applies to every station that this window shows.
std::vector<StationPanel*>& panels() {
  static std::vector<StationPanel*> all;
  return all;
}

/// Combo box that ignores the wheel, so that scrolling does not load another instrument. Its list
/// opens below it and ends within the screen, so that it never covers the emergency stop above.
class Chooser : public QComboBox {
 public:
  Chooser() { setStyleSheet("QComboBox { combobox-popup: 0; }"); }

  void showPopup() override {
    const int room = screen()->availableGeometry().bottom() - mapToGlobal(rect().bottomLeft()).y();
    setMaxVisibleItems(std::max(room / std::max(view()->sizeHintForRow(0), 1) - 1, 1));
    QComboBox::showPopup();
  }

 protected:
  void wheelEvent(QWheelEvent* event) override { event->ignore(); }
  void paintEvent(QPaintEvent* event) override {
    QComboBox::paintEvent(event);
    if (currentIndex() < 0) {  // Qt 5.15 shows no placeholder in lists (QTBUG-90595)
      QPainter painter(this);
      painter.setPen(palette().color(QPalette::Disabled, QPalette::Text));
      painter.drawText(rect().adjusted(8, 0, -28, 0), Qt::AlignVCenter, placeholderText());
    }
  }
};

/// Presses a button also where a list or a menu is open, which otherwise takes the first press of
/// the mouse for itself.
class PressBesidePopup : public QObject {
 public:
  explicit PressBesidePopup(QPushButton* button) : QObject(button), button_(button) {
    qApp->installEventFilter(this);
  }

  bool eventFilter(QObject* watched, QEvent* event) override {
    if (event->type() == QEvent::MouseButtonPress && watched == QApplication::activePopupWidget()) {
      const QPoint at = button_->mapFromGlobal(static_cast<QMouseEvent*>(event)->globalPos());
      if (button_->isVisible() && button_->rect().contains(at)) {
        button_->click();
      }
    }
    return false;
  }

 private:
  QPushButton* button_;
};

QLabel* title(const QString& text) {
  auto* label = adopted<QLabel>(text);
  QFont font = label->font();
  font.setBold(true);
  label->setFont(font);
  return label;
}

int percent(double share) {
  return static_cast<int>(std::lround(100.0 * share));
}

}  // namespace

StationPanel::StationPanel(QWidget* parent) : rviz::Panel(parent), wanted_(kUsualStation) {
  panels().push_back(this);
  clock_.start();
  auto* column = adopted<QVBoxLayout>(this);
  column->setContentsMargins(6, 6, 6, 6);
  column->setSpacing(5);
  addForce(column);  // always in sight; what follows scrolls in a low window
  scroll_ = adopted<QScrollArea>();
  scroll_->setWidgetResizable(true);
  scroll_->setFrameShape(QFrame::NoFrame);
  scroll_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  auto* inside = adopted<QWidget>();
  auto* rest = adopted<QVBoxLayout>(inside);
  rest->setContentsMargins(0, 0, 0, 0);
  rest->setSpacing(4);
  addInstruments(rest);
  addParameters(rest);
  addPresets(rest);
  addMeters(rest);
  addSound(rest);
  addTakes(rest);
  addMessages(rest);
  scroll_->setWidget(inside);
  column->addWidget(scroll_, 1);
  QObject::connect(watch_, &QPushButton::toggled, scroll_, [this](bool is_on) {
    QTimer::singleShot(0, scroll_, [this, is_on] {  // when it has its place
      scroll_->ensureWidgetVisible(is_on ? static_cast<QWidget*>(scope_) : volume_);
    });
  });
  setMinimumWidth(300);
  addKeys();
  QObject::connect(&timer_, &QTimer::timeout, this, [this] { refresh(); });
}

StationPanel::~StationPanel() {
  panels().erase(std::remove(panels().begin(), panels().end(), this), panels().end());
}

void StationPanel::onInitialize() {
  // Here, for neither rospack nor the environment is made for several threads, and rviz asks in
  // this one.
  tzset();
  models_ = ros::package::getPath("ergotic") + "/models";
  timer_.start(kRefreshMs);
}

void StationPanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  QString station;
  if (config.mapGetString(kSetting, &station)) {
    station_->setText(station);
    wanted_ = station.toStdString();
  }
}

void StationPanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue(kSetting, QString::fromStdString(wanted_));
}

QPushButton* StationPanel::addButton(const QString& text, const QString& tip) {
  auto* button = adopted<QPushButton>(text);
  button->setToolTip(tip);
  button->setMinimumHeight(30);
  button->setAutoDefault(false);
  return button;
}

std::function<void()> StationPanel::press(void (StationLink::*act)()) {
  return [this, act] {
    if (link_) {
      (link_.get()->*act)();
    }
  };
}

void StationPanel::addForce(QVBoxLayout* column) {
  lamp_ = adopted<LampWidget>(this);
  engage_ = addButton("Engage  F5", "Lets force ramp in");
  stop_ = addButton("Stop  F6", "Takes force away, until Engage");
  recover_ = addButton("Recover  F7", "Ends a fault; force stays at zero until Engage");
  emergency_ = addButton("EMERGENCY STOP  F12", "Takes force away at once, until Recover");
  emergency_->setMinimumHeight(46);
  emergency_->setStyleSheet(
      "QPushButton { background: #b81414; color: white; font-weight: bold; font-size: 15px;"
      " border: 2px solid #7d0c0c; border-radius: 6px; }"
      "QPushButton:pressed { background: #7d0c0c; }"
      "QPushButton:focus { border-color: white; }");
  QObject::connect(engage_, &QPushButton::clicked, this, press(&StationLink::engage));
  QObject::connect(stop_, &QPushButton::clicked, this, press(&StationLink::stop));
  QObject::connect(recover_, &QPushButton::clicked, this, press(&StationLink::recover));
  QObject::connect(emergency_, &QPushButton::clicked, this, press(&StationLink::emergencyStop));
  adopted<PressBesidePopup>(emergency_);
  answer_ = adopted<Paragraph>(2, this);

  column->addWidget(lamp_);
  auto* buttons = adopted<QHBoxLayout>();
  buttons->setSpacing(5);
  for (QPushButton* button : {engage_, stop_, recover_}) {
    buttons->addWidget(button, 1);
  }
  column->addLayout(buttons);
  column->addWidget(emergency_);
  column->addWidget(answer_);
}

void StationPanel::addInstruments(QVBoxLayout* column) {
  instruments_ = adopted<Chooser>();
  instruments_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);

  instruments_->setAccessibleName("instruments");
  instruments_->setIconSize({60, 36});
  instruments_->setPlaceholderText("choose an instrument");
  QObject::connect(instruments_, QOverload<int>::of(&QComboBox::activated), this, [this](int row) {
    const auto index = static_cast<std::size_t>(row);
    if (index < news_.scenes.size()) {
      choose(news_.scenes[index]);
    }
  });
  about_ = adopted<Paragraph>(2, this);

  verdict_ = adopted<QLabel>();
  verdict_->setAlignment(Qt::AlignRight);
  verdict_->setToolTip("Whether what plays is proven to be stable: passive, bounded, unproven");
  reload_ = adopted<QPushButton>("↻");
  reload_->setAutoDefault(false);
  reload_->setFixedSize(26, 22);
  reload_->setAccessibleName("read the scene again");
  reload_->setToolTip("Reads the scene's file again, with the parameters as they are (Shift+F5)");
  QObject::connect(reload_, &QPushButton::clicked, this, press(&StationLink::reload));
  auto* line = adopted<QHBoxLayout>();
  line->addWidget(title("Instrument (F3)"));
  line->addWidget(verdict_, 1);
  line->addWidget(reload_);
  column->addLayout(line);
  column->addWidget(instruments_);
  column->addWidget(about_);
}

void StationPanel::addParameters(QVBoxLayout* column) {
  parameters_ = adopted<ParameterList>(
      [this](const std::string& parameter) {
        if (link_) {
          link_->learnController(parameter);
        }
      },
      this);
  parameters_->setMinimumHeight(92);
  auto* reset = adopted<QPushButton>("Defaults");
  reset->setToolTip("Sets all parameters to what the scene begins with");
  reset->setAutoDefault(false);
  QObject::connect(reset, &QPushButton::clicked, this, [this] { parameters_->toDefaults(); });
  auto* line = adopted<QHBoxLayout>();
  line->addWidget(title("Parameters (F4)"), 1);
  line->addWidget(reset);
  column->addLayout(line);
  column->addWidget(parameters_, 3);
}

void StationPanel::addPresets(QVBoxLayout* column) {
  PresetRow::Acts acts;
  acts.keep = [this](const std::string& name) {
    link_->preset("Keep", Preset::Request::KEEP, name);
  };
  acts.recall = [this](const std::string& name, double seconds) {
    link_->preset("Recall", Preset::Request::RECALL, name, seconds);
  };
  acts.undo = [this] { link_->preset("Undo", Preset::Request::UNDO); };
  presets_ = adopted<PresetRow>(std::move(acts), this);
  column->addWidget(presets_);
}

void StationPanel::addMeters(QVBoxLayout* column) {
  force_title_ = title("Forces");
  forces_ = adopted<ForceMeter>(this);
  load_ = adopted<QProgressBar>();
  load_->setRange(0, 100);
  load_->setFixedHeight(18);
  rates_ = adopted<Paragraph>(1, this);
  column->addWidget(force_title_);
  column->addWidget(forces_);
  column->addWidget(load_);
  column->addWidget(rates_);
}

void StationPanel::addSound(QVBoxLayout* column) {
  sound_title_ = title("Sound");
  mute_ = adopted<QPushButton>("Mute  F8");
  mute_->setCheckable(true);
  mute_->setAutoDefault(false);
  mute_->setToolTip("Silence at JACK; the instrument plays on");
  volume_ = adopted<QSlider>(Qt::Horizontal);
  volume_->setRange(0, kVolumeSteps);
  volume_->setValue(kVolumeSteps);
  volume_->setAccessibleName("master volume");
  volume_->setToolTip("Master volume, half a decibel a step");
  const auto send = [this] {
    if (link_) {
      link_->setVolume(mute_->isChecked() ? 0.0 : volumeAt(volume_->value()));
    }
  };
  QObject::connect(volume_, &QSlider::valueChanged, this, send);
  QObject::connect(mute_, &QPushButton::toggled, this, send);
  sound_ = adopted<SoundMeter>(this);
  watch_ = adopted<QPushButton>("Scope");
  watch_->setCheckable(true);
  watch_->setAutoDefault(false);
  watch_->setFixedHeight(20);
  watch_->setToolTip("Shows waves and spectra of the outputs");
  scope_ = adopted<ScopeWidget>(this);
  scope_->hide();
  QObject::connect(watch_, &QPushButton::toggled, scope_, &QWidget::setVisible);
  auto* line = adopted<QHBoxLayout>();
  line->addWidget(sound_title_, 2);
  line->addWidget(volume_, 2);
  line->addWidget(mute_);
  column->addLayout(line);
  auto* below = adopted<QHBoxLayout>();
  below->addWidget(sound_, 1);
  below->addWidget(watch_);
  column->addLayout(below);
  column->addWidget(scope_);
}

TakeList::Acts StationPanel::takeActs() {
  TakeList::Acts acts;
  acts.play = [this](const std::string& name) { link_->replay(name); };
  acts.rename = [this](const std::string& name, const std::string& new_name) {
    link_->changeTake("Rename", Take::Request::RENAME, name, new_name);
  };
  acts.star = [this](const std::string& name, bool is_starred) {
    link_->changeTake("Star", is_starred ? Take::Request::STAR : Take::Request::UNSTAR, name);
  };
  acts.discard = [this](const std::string& name) {
    link_->changeTake("Delete", Take::Request::DELETE, name);
  };
  return acts;
}

void StationPanel::addTakes(QVBoxLayout* column) {
  takes_title_ = title("Takes");
  takes_ = adopted<TakeList>(takeActs(), this);
  takes_->setMinimumHeight(86);
  record_ = addButton("Record  F9", "Records what is played, until it is pressed again");
  replay_ = addButton("Replay  F10", "Plays the chosen take through the same outputs");
  QObject::connect(record_, &QPushButton::clicked, this, [this] {
    press(news_.takes.recording.empty() ? &StationLink::record : &StationLink::finishTake)();
  });
  QObject::connect(replay_, &QPushButton::clicked, this, [this] {
    if (!news_.takes.replaying.empty()) {
      press (&StationLink::haltTake)();
    } else if (link_) {
      link_->replay(takes_->chosen());
    }
  });
  auto* line = adopted<QHBoxLayout>();
  line->addWidget(takes_title_, 1);
  line->addWidget(record_);
  line->addWidget(replay_);
  column->addLayout(line);
  column->addWidget(takes_, 2);
}

void StationPanel::addMessages(QVBoxLayout* column) {
  messages_ = adopted<QPlainTextEdit>();
  messages_->setReadOnly(true);
  messages_->setMinimumHeight(46);
  messages_->setTabChangesFocus(true);
  QFont font = messages_->font();
  font.setPointSizeF(0.9 * font.pointSizeF());
  messages_->setFont(font);
  station_ = adopted<QLineEdit>(kUsualStation);
  station_->setToolTip("Name of the station; it is kept in the configuration of rviz");
  QObject::connect(station_, &QLineEdit::editingFinished, this, [this] {
    if (station_->text().toStdString() != wanted_) {
      wanted_ = station_->text().toStdString();
      Q_EMIT configChanged();
    }
  });
  auto* line = adopted<QHBoxLayout>();
  line->addWidget(title("Messages"), 1);
  line->addWidget(adopted<QLabel>("of station"));
  line->addWidget(station_, 1);
  column->addLayout(line);
  column->addWidget(messages_, 2);
}

void StationPanel::bind(const QKeySequence& keys,
                        const std::function<void()>& act,
                        bool also_ambiguous) {
  auto* shortcut = adopted<QShortcut>(keys, this);
  shortcut->setContext(Qt::ApplicationShortcut);
  shortcut->setAutoRepeat(false);
  QObject::connect(shortcut, &QShortcut::activated, this, act);
  if (also_ambiguous) {  // several panels
    QObject::connect(shortcut, &QShortcut::activatedAmbiguously, this, act);
  }
}

/// Binds function keys; letters are shortcuts of rviz's tools.
void StationPanel::addKeys() {
  const auto on_all = [](void (StationLink::*act)()) {
    for (StationPanel* panel : panels()) {
      panel->press(act)();
    }
  };
  bind(Qt::Key_F5, [this] { engage_->click(); });
  bind(
      Qt::Key_F6, [on_all] { on_all(&StationLink::stop); }, true);
  bind(QKeySequence("Shift+F5"), [this] { reload_->click(); });
  bind(Qt::Key_F7, [this] { recover_->click(); });
  bind(Qt::Key_F8, [this] { mute_->toggle(); });
  bind(
      Qt::Key_F12, [on_all] { on_all(&StationLink::emergencyStop); }, true);
  bind(Qt::Key_F9, [this] { record_->click(); });
  bind(Qt::Key_F10, [this] { replay_->click(); });
  bind(Qt::Key_F3, [this] { instruments_->setFocus(Qt::ShortcutFocusReason); });
  bind(Qt::Key_F4, [this] { parameters_->takeFocus(); });
  bind(QKeySequence("Shift+F4"), [this] { presets_->takeFocus(); });
  bind(QKeySequence("Shift+F10"), [this] {
    takes_->setFocus(Qt::ShortcutFocusReason);
    scroll_->ensureWidgetVisible(takes_);
  });
  auto* undo = adopted<QShortcut>(QKeySequence::Undo, this);
  undo->setContext(Qt::WidgetWithChildrenShortcut);
  QObject::connect(undo, &QShortcut::activated, this, [this] { presets_->undo(); });
}

void StationPanel::connect() {
  link_.reset();
  link_ = std::make_unique<StationLink>(wanted_, models_);
  news_ = {};
  scenes_shown_ = log_shown_ = takes_shown_ = device_shown_ = 0;
  takes_->show({});
  model_shown_.clear();
  instruments_->clear();  // they are no longer in the news
  messages_->clear();
}

void StationPanel::refresh() {
  if (!link_ || link_->station() != wanted_) {
    connect();
  }
  link_->refresh(news_);
  const double now_s = 1e-3 * static_cast<double>(clock_.elapsed());
  parameters_->send(
      [this](const std::string& name, double value) { link_->setParameter(name, value); }, now_s);
  showForce();
  showInstruments();
  parameters_->setEnabled(!isStale());
  parameters_->follow(news_.parameters, now_s);
  presets_->show(news_.presets, !isStale());
  showMeters();
  showSound();
  showTakes();
  showMessages();
  showDevice();
}

/// Models of robots that the window has: rviz reads a URDF once.
void StationPanel::showDevice() {
  if (std::exchange(device_shown_, news_.device_version) != news_.device_version) {
    reloadRobotModels(*vis_manager_);
  }
}

void StationPanel::showForce() {
  const Lamp lamp = lampOf(news_.status.state, news_.age_s);
  lamp_->show(lamp, reasonOf(lamp, news_.status, news_.age_s, link_->station(), news_.has_master));
  engage_->setEnabled(lamp != Lamp::kStale);
  recover_->setEnabled(lamp != Lamp::kStale);
  answer_->show(news_.answer.text, !news_.answer.ok);
}

void StationPanel::showInstruments() {
  const bool are_others = scenes_shown_ != news_.scenes_version;
  if (are_others) {
    scenes_shown_ = news_.scenes_version;
    instruments_->clear();
    for (const SceneEntry& scene : news_.scenes) {
      instruments_->addItem(QIcon(QString::fromStdString(scene.picture)),
                            QString::fromStdString(scene.title));
    }
  }
  if (are_others || model_shown_ != news_.status.model) {
    model_shown_ = news_.status.model;
    instruments_->setPlaceholderText(model_shown_.empty() ? "choose an instrument"
                                                          : QString::fromStdString(model_shown_));
    const auto is_it = [this](const SceneEntry& scene) { return scene.name == model_shown_; };
    const auto chosen = static_cast<std::size_t>(std::max(instruments_->currentIndex(), 0));
    if (are_others || chosen >= news_.scenes.size() || !is_it(news_.scenes[chosen])) {
      const auto found = std::find_if(news_.scenes.begin(), news_.scenes.end(), is_it);
      instruments_->setCurrentIndex(
          found == news_.scenes.end() ? -1 : static_cast<int>(found - news_.scenes.begin()));
    }
  }
  reload_->setEnabled(!isStale());
  const int row = instruments_->currentIndex();
  about_->show(row < 0 ? "" : news_.scenes[static_cast<std::size_t>(row)].about);
  const std::string& verdict = news_.status.verdict;
  verdict_->setText(
      isStale() || verdict.empty() ? "" : "certificate: " + QString::fromStdString(verdict));
}

void StationPanel::choose(const SceneEntry& scene) {
  link_->load(scene.model, scene.title);
}

void StationPanel::showMeters() {
  const bool stale = isStale() || news_.status.state == Status::DISCONNECTED;
  double largest = 0.0;
  for (const double peak : news_.peaks) {
    largest = std::max(largest, peak);
  }
  forces_->show(news_.forces, news_.peaks, news_.force_limit, !stale);
  force_title_->setText(stale ? "Forces"
                              : QString("Forces: %1 N of %2 N")
                                    .arg(largest, 0, 'f', 2)
                                    .arg(news_.force_limit, 0, 'g', 3));
  const Status& status = news_.status;
  load_->setEnabled(!stale);
  load_->setValue(stale ? 0 : std::clamp(percent(status.load_mean), 0, 100));
  load_->setFormat(stale ? QString("load") : QString("load %1 %").arg(percent(status.load_mean)));
  load_->setToolTip(
      QString("Computing time of a tick over the time there is. The largest since the start was %1 "
              "%; moments in which the machine was held up count, too.")
          .arg(percent(status.load_peak)));
  rates_->show(stale ? "" : ratesText(status));
}

/// Shows levels and volume. The slider follows the station, unless a user moves it or the station
/// is silent.
void StationPanel::showSound() {
  const bool is_known = !isStale() && news_.hears_sound;
  sound_->show(news_.levels, news_.level_peaks, is_known);
  link_->watchSound(scope_->isVisible());  // a hidden dock sees nothing
  scope_->ScopeWidget::show(is_known ? news_.sound : nullptr);
  volume_->setEnabled(is_known);
  mute_->setEnabled(is_known);
  double loudest = 0.0;
  for (const double peak : news_.level_peaks) {
    loudest = std::max(loudest, peak);
  }
  sound_title_->setText(!is_known          ? QString("Sound")
                        : news_.is_limited ? QString("Sound: limited")
                        : loudest < kSilence
                            ? QString("Sound: silent")
                            : QString("Sound: %1 dB").arg(20.0 * std::log10(loudest), 0, 'f', 0));
  if (is_known && !volume_->isSliderDown() && !volume_->hasFocus() && news_.volume > 0.0 &&
      stepOfVolume(news_.volume) != volume_->value()) {
    const QSignalBlocker quiet(volume_);
    volume_->setValue(stepOfVolume(news_.volume));
  }
}

void StationPanel::showTakes() {
  record_->setEnabled(!isStale());
  replay_->setEnabled(!isStale() && (!news_.takes.names.empty() || !news_.takes.replaying.empty()));
  takes_->show(news_.takes);  // also what came while a name was edited
  if (takes_shown_ == news_.takes_version) {
    return;
  }
  takes_shown_ = news_.takes_version;
  const Takes& takes = news_.takes;
  const bool records = !takes.recording.empty();
  const bool plays = !takes.replaying.empty();
  record_->setText(records ? "Finish  F9" : "Record  F9");
  replay_->setText(plays ? "Halt  F10" : "Replay  F10");
  takes_title_->setText(
      records ? QString("● recording %1 s").arg(takes.recorded, 0, 'f', 1)
      : plays ? QString("▶ %1 of %2 s").arg(takes.replayed, 0, 'f', 1).arg(takes.length, 0, 'f', 1)
              : QString("Takes"));
}

void StationPanel::showMessages() {
  if (log_shown_ == news_.log_version) {
    return;
  }
  log_shown_ = news_.log_version;
  QScrollBar* bar = messages_->verticalScrollBar();
  const bool reads_back = bar->value() < bar->maximum();
  const int place = bar->value();
  messages_->setPlainText(QString::fromStdString(news_.log));
  if (reads_back) {
    bar->setValue(place);
  } else {
    messages_->moveCursor(QTextCursor::End);
    bar->setValue(bar->maximum());
  }
}

}  // namespace ergotic::panel

PLUGINLIB_EXPORT_CLASS(ergotic::panel::StationPanel, rviz::Panel)
