// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/take_list.hpp"

#include <QAction>
#include <QDateTime>
#include <QHeaderView>
#include <algorithm>
#include <utility>

#include "rviz/widgets.hpp"
#include "rviz/words.hpp"

namespace ergotic::panel {
namespace {

enum Column : int { kStarColumn, kNameColumn, kLengthColumn, kInstrumentColumn, kDateColumn };

QString lengthText(double seconds) {
  return seconds > 0.0 ? QString("%1 s").arg(seconds, 0, 'f', 1) : QString();
}

QString dateText(const ros::Time& date) {
  return QDateTime::fromSecsSinceEpoch(static_cast<qint64>(date.sec)).toString("yyyy-MM-dd hh:mm");
}

}  // namespace

TakeList::TakeList(Acts acts, QWidget* parent) : QTreeWidget(parent), acts_(std::move(acts)) {
  setAccessibleName("takes");
  setHeaderLabels({"★", "Take", "Length", "Instrument", "Date"});
  setRootIsDecorated(false);
  setUniformRowHeights(true);
  setEditTriggers(QAbstractItemView::NoEditTriggers);
  setContextMenuPolicy(Qt::ActionsContextMenu);
  header()->setSectionResizeMode(QHeaderView::ResizeToContents);
  setToolTip(
      "Return plays the chosen take, F2 renames it, Space stars it, Delete moves it to the trash");
  addAct("Play", {Qt::Key_Return, Qt::Key_Enter}, [this] { acts_.play(chosen()); });
  addAct("Rename", {Qt::Key_F2}, [this] { editItem(currentItem(), kNameColumn); });
  addAct("Star, or take the star away", {Qt::Key_Space},
         [this] { acts_.star(chosen(), !isStarred()); });
  addAct("Move to the trash", {Qt::Key_Delete}, [this] { acts_.discard(chosen()); });
  QObject::connect(this, &QTreeWidget::itemDoubleClicked, this,
                   [this](QTreeWidgetItem*, int) { acts_.play(chosen()); });
  QObject::connect(this, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem* item, int) {
    const auto row = static_cast<std::size_t>(indexOfTopLevelItem(item));
    if (fills_ || row >= shown_.names.size()) {
      return;
    }
    const std::string name = shown_.names[row];
    const std::string new_name = nameText(item->text(kNameColumn).toStdString());
    fills_ = true;  // it has its old name until the station says otherwise
    item->setText(kNameColumn, QString::fromStdString(name));
    fills_ = false;
    if (new_name != name) {
      acts_.rename(name, new_name);
    }
  });
}

/// While a name is edited, its keys are those of the editor.
void TakeList::addAct(const QString& text,
                      const QList<QKeySequence>& keys,
                      const std::function<void()>& act) {
  auto* action = adopted<QAction>(text, this);
  action->setShortcuts(keys);
  action->setShortcutContext(Qt::WidgetShortcut);
  QObject::connect(action, &QAction::triggered, this, [this, act] {
    if (currentItem() != nullptr) {
      act();
    }
  });
  addAction(action);
}

std::string TakeList::chosen() const {
  return currentItem() == nullptr ? "" : currentItem()->text(kNameColumn).toStdString();
}

bool TakeList::isStarred() const {
  return currentItem() != nullptr && !currentItem()->text(kStarColumn).isEmpty();
}

bool TakeList::isShown(const Takes& takes) const {
  return takes.names == shown_.names && takes.starred == shown_.starred &&
         takes.lengths == shown_.lengths && takes.instruments == shown_.instruments &&
         takes.dates == shown_.dates;
}

void TakeList::show(const Takes& takes) {
  const std::size_t count = takes.names.size();
  const bool is_whole = takes.starred.size() == count && takes.lengths.size() == count &&
                        takes.instruments.size() == count && takes.dates.size() == count;
  if (!is_whole || isShown(takes) || state() == EditingState) {
    return;
  }
  fills_ = true;
  fill(takes);
  fills_ = false;
}

void TakeList::fill(const Takes& takes) {
  const std::vector<std::string>& before = shown_.names;
  const bool is_new = !takes.names.empty() &&
                      std::find(before.begin(), before.end(), takes.names[0]) == before.end();
  const int row = indexOfTopLevelItem(currentItem());
  const std::string wanted = is_new ? takes.names[0] : chosen();
  clear();
  for (std::size_t i = 0; i < takes.names.size(); ++i) {
    auto* item = adopted<QTreeWidgetItem>(
        QStringList{takes.starred[i] != 0U ? "★" : "", QString::fromStdString(takes.names[i]),
                    lengthText(takes.lengths[i]), QString::fromStdString(takes.instruments[i]),
                    dateText(takes.dates[i])});
    item->setFlags(item->flags() | Qt::ItemIsEditable);
    addTopLevelItem(item);
    if (takes.names[i] == wanted) {
      setCurrentItem(item);
    }
  }
  if (currentItem() == nullptr && topLevelItemCount() > 0) {  // it was renamed, or is gone
    setCurrentItem(topLevelItem(std::clamp(row, 0, topLevelItemCount() - 1)));
  }
  shown_ = takes;
}

}  // namespace ergotic::panel
