// SPDX-License-Identifier: BSD-3-Clause
#include <pluginlib/class_list_macros.hpp>

#include "tgr/drivers/jack/jack_driver.hpp"

PLUGINLIB_EXPORT_CLASS(ergotic::tgr::JackFactory, ergotic::tgr::DriverFactory)
