// SPDX-License-Identifier: BSD-3-Clause
#include <pluginlib/class_list_macros.hpp>

#include "tgr/drivers/comedi/comedi_factory.hpp"

PLUGINLIB_EXPORT_CLASS(ergotic::tgr::ComediFactory, ergotic::tgr::DriverFactory)
