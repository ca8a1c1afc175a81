// SPDX-License-Identifier: BSD-3-Clause
// Pens of graphics tablets, by events as Qt's window system makes them, on no screen.
#include <QApplication>
#include <QMouseEvent>
#include <QTabletEvent>
#include <QWidget>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "rviz/pen_filter.hpp"

namespace ergotic::panel {
namespace {

class PenFilterTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    static int count = 1;
    static char name[] = "pen_events";
    static char* words[] = {name, nullptr};
    qputenv("QT_QPA_PLATFORM", "offscreen");
    application_ = std::make_unique<QApplication>(count, words);
  }
  static void TearDownTestSuite() { application_.reset(); }
  void SetUp() override { widget_.installEventFilter(&filter_); }
  /// \return whether somebody accepted it
  bool send(QEvent::Type type, double pressure) {
    const QPointF place(5.0, 5.0);
    const Qt::MouseButtons down = type == QEvent::TabletRelease ? Qt::NoButton : Qt::LeftButton;
    const auto changed = type == QEvent::TabletMove ? Qt::NoButton : Qt::LeftButton;
    QTabletEvent event(type, place, place, QTabletEvent::Stylus, QTabletEvent::Pen, pressure, 0, 0,
                       0.0, 0.0, 0, Qt::NoModifier, 1, changed, down);
    QApplication::sendEvent(&widget_, &event);
    return event.isAccepted();
  }

  static std::unique_ptr<QApplication> application_;
  QWidget widget_;
  std::vector<double> pushes_;
  PenFilter filter_{[this](double depth_m) { pushes_.push_back(depth_m); }};
};

std::unique_ptr<QApplication> PenFilterTest::application_;

TEST_F(PenFilterTest, PressingHarderGoesDeeper) {
  send(QEvent::TabletPress, 0.1);
  send(QEvent::TabletMove, 0.6);
  send(QEvent::TabletMove, 0.6);
  send(QEvent::TabletMove, 0.2);
  ASSERT_EQ(pushes_.size(), 3U) << "a pen that presses as before pushes no further";
  EXPECT_NEAR(pushes_[0], 0.1 * PenFilter::kDepthM, 1e-12);
  EXPECT_NEAR(pushes_[1], 0.5 * PenFilter::kDepthM, 1e-12);
  EXPECT_NEAR(pushes_[2], -0.4 * PenFilter::kDepthM, 1e-12);
}

TEST_F(PenFilterTest, ThePenThatIsLiftedBeginsAnew) {
  send(QEvent::TabletPress, 0.1);
  send(QEvent::TabletMove, 1.0);
  send(QEvent::TabletRelease, 0.0);
  EXPECT_EQ(pushes_.size(), 2U) << "it does not push back what is let go of";
  send(QEvent::TabletPress, 0.5);
  ASSERT_EQ(pushes_.size(), 3U);
  EXPECT_NEAR(pushes_[2], 0.5 * PenFilter::kDepthM, 1e-12);
}

TEST_F(PenFilterTest, ItsEventsAreLeftToQtWhichMakesThoseOfAMouseOfThem) {
  EXPECT_FALSE(send(QEvent::TabletPress, 0.5));
  EXPECT_FALSE(send(QEvent::TabletMove, 0.7));
  EXPECT_FALSE(send(QEvent::TabletRelease, 0.0));
  EXPECT_TRUE(QCoreApplication::testAttribute(Qt::AA_SynthesizeMouseForUnhandledTabletEvents));
}

TEST_F(PenFilterTest, AMousePressesNothing) {
  QMouseEvent press(QEvent::MouseButtonPress, QPointF(5.0, 5.0), Qt::LeftButton, Qt::LeftButton,
                    Qt::NoModifier);
  QApplication::sendEvent(&widget_, &press);
  EXPECT_TRUE(pushes_.empty());
}

}  // namespace
}  // namespace ergotic::panel
