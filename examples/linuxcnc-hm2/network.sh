#!/bin/sh
# As root: two networks joined by a veth pair. hm2_eth changes iptables and ARP entries of the network that it is in, so
# it gets one of its own. `network.sh remove` takes both away.
set -e
if [ "$1" = remove ]; then
  ip netns del trammel-cnc
  ip netns del trammel-card
  exit
fi
ip netns add trammel-cnc
ip netns add trammel-card
ip link add cnc netns trammel-cnc type veth peer name card netns trammel-card
ip -n trammel-cnc link set lo up
ip -n trammel-cnc addr add 192.168.81.1/24 dev cnc
ip -n trammel-cnc link set cnc up
ip -n trammel-card addr add 192.168.81.2/24 dev card
ip -n trammel-card link set card up
